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
        self._cpu_s, self._waited_s, self._start = self._cpu(), self._waited(), time.monotonic()

    def _cpu(self):
        fields = (self._proc / "stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / _TICKS_PER_S

    def _waited(self):
        waits = [int((task / "schedstat").read_text().split()[1])
                 for task in (self._proc / "task").iterdir()]
        return 1e-9 * sum(waits)

    def waited(self):
        """Share of the time that its threads were ready to run and got no core, summed over them."""
        return (self._waited() - self._waited_s) / (time.monotonic() - self._start)

    def read(self):
        """Share of one core, and the most memory that was ever resident, MB of 10^6 bytes."""
        lines = (self._proc / "status").read_text().splitlines()
        peak_kib = next(int(line.split()[1]) for line in lines if line.startswith("VmHWM:"))
        took_s = time.monotonic() - self._start
        return {"cores": (self._cpu() - self._cpu_s) / took_s, "peak_mb": peak_kib * 1.024e-3}


class MachineLoad:
    """Since it was made."""

    def __init__(self):
        self._idle_s, self._start = self._idle(), time.monotonic()

    @staticmethod
    def _idle():
        fields = pathlib.Path("/proc/stat").read_text().splitlines()[0].split()
        return (int(fields[4]) + int(fields[5])) / _TICKS_PER_S  # waiting for the disk included

    def idle_cores(self):
        """Cores that nobody on the machine used."""
        return (self._idle() - self._idle_s) / (time.monotonic() - self._start)
