# SPDX-License-Identifier: Apache-2.0
"""warren-bench peers: many light robots in one process."""
import json
import pathlib
import subprocess

from . import processes


class LightPeers:
    """Over the loopback interface to `bases`, nodes that are to get all; publishing from "ready" on."""

    def __init__(self, bin_dir, key, bases, **options):
        """options: as the program has them, with underscores."""
        flags = [word for name, value in options.items()
                 for word in (f"--{name.replace('_', '-')}", value)]
        to = ",".join(f"127.0.0.1:{node.port}" for node in bases)
        self._said = []
        self._process = processes.start(
            [pathlib.Path(bin_dir) / "warren-bench", "peers", "--base", to, "--key", key, "--json",
             *flags], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def await_line(self, line):
        """ready, published"""
        for said in self._process.stderr:
            if said.strip() == line:
                return
            self._said.append(said)
        raise RuntimeError("the light robots ended: " + "".join(self._said[-8:]))

    def result(self):
        """Once the bases have all, or have not in time."""
        said, errors = self._process.communicate()
        if not said:
            raise RuntimeError("the light robots ended: " + errors[-500:])
        return json.loads(said)

    def end(self):
        processes.end(self._process)
