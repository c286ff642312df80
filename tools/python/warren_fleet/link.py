# SPDX-License-Identifier: Apache-2.0
"""warren-link: a network namespace for every node, and the radio between them."""
import json
import os
import pathlib
import select
import subprocess
import time

from . import processes


def why_not():
    """Why there can be no namespaces here; None if there can."""
    if os.geteuid() != 0:
        return "network namespaces need root"
    if not pathlib.Path("/dev/net/tun").exists():
        return "there is no /dev/net/tun"
    if not any(pathlib.Path(folder, "ip").exists() for folder in ("/usr/sbin", "/sbin", "/bin")):
        return "there is no iproute2"
    return None


class Link:
    """Running until `close`. Not for two threads."""

    def __init__(self, binary, nodes, options, log):
        command = [binary, "--tap", "--nodes", nodes, "--control", *options]
        self._log = open(log, "ab")
        self._process = processes.start(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self._log)
        self._buffer = b""
        self.namespaces = []
        self.started = time.time()
        while (line := self._line(60.0)) != "ready":
            self.namespaces.append(line.split()[2])

    def _line(self, timeout_s):
        until = time.monotonic() + timeout_s
        while b"\n" not in self._buffer:
            left = until - time.monotonic()
            ready = left > 0 and select.select([self._process.stdout], [], [], left)[0]
            more = os.read(self._process.stdout.fileno(), 65536) if ready else b""
            if not more:
                raise RuntimeError("warren-link ended, or says nothing: see its log")
            self._buffer += more
        line, self._buffer = self._buffer.split(b"\n", 1)
        return line.decode()

    def tell(self, word):
        """off, on"""
        self._process.stdin.write(word.encode() + b"\n")
        self._process.stdin.flush()

    def stats(self):
        self.tell("stats")
        return json.loads(self._line(10.0))

    def close(self):
        """Its last counts, or None; the namespaces are gone then."""
        try:
            last = self.stats()
        except (OSError, RuntimeError, ValueError):
            last = None
        processes.end(self._process, 20.0)
        self._log.close()
        return last
