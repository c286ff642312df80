# SPDX-License-Identifier: Apache-2.0
"""What a process takes of the machine, as the kernel counts it."""
import os
import pathlib
import time

_TICKS_PER_S = os.sysconf("SC_CLK_TCK")


class ProcessLoad:
    """Since it was made."""

    def __init__(self, pid):
        self._proc = pathlib.Path(f"/proc/{pid}")
        self._cpu_s, self._start = self._cpu(), time.monotonic()

    def _cpu(self):
        fields = (self._proc / "stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / _TICKS_PER_S

    def read(self):
        """Share of one core, and the most memory that was ever resident, MB of 10^6 bytes."""
        lines = (self._proc / "status").read_text().splitlines()
        peak_kib = next(int(line.split()[1]) for line in lines if line.startswith("VmHWM:"))
        took_s = time.monotonic() - self._start
        return {"cores": (self._cpu() - self._cpu_s) / took_s, "peak_mb": peak_kib * 1.024e-3}
