# SPDX-License-Identifier: Apache-2.0
"""warren-sim: what the robots see, and how their radios reach."""
import json
import pathlib

from . import processes


class World:
    """Robots in a simulated world; the same for all that is asked of it."""

    def __init__(self, bin_dir, *, preset, seed, seconds, robots, length_m=0, stagger_s=10.0,
                 speed_m_s=1.0):
        self._sim = pathlib.Path(bin_dir) / "warren-sim"
        self.seed, self.seconds = seed, seconds
        self._who = ["--world", preset, "--seed", seed, "--length", length_m, "--seconds", seconds,
                     "--robots", robots, "--stagger", stagger_s, "--speed", speed_m_s]

    def radio(self, folder):
        """The trace file: nodes base, robot-0, robot-1.."""
        processes.run([self._sim, "radio", *self._who, "--out", folder], timeout_s=300.0)
        return pathlib.Path(folder) / "radio.csv"

    def drive(self, sockets, log, *, columns=1024, rate_hz=10.0, pace="real", extra=()):
        """The process; its summary is for `summary_of`."""
        flags = [word for path in sockets for word in ("--socket", path)]
        with open(log, "wb") as errors:
            return processes.start(
                [self._sim, "run", *self._who, *flags, "--columns", columns, "--lidar-rate", rate_hz,
                 "--rate", pace, "--frame-epoch", 1, "--json", *extra],
                stdout=open(f"{log}.json", "wb"), stderr=errors)


def summary_of(log):
    """None if it was ended before it could say any."""
    text = pathlib.Path(f"{log}.json").read_text()
    return json.loads(text) if text.strip() else None
