# SPDX-License-Identifier: Apache-2.0
"""A warrend of one's own: its config, its lives, its control socket."""
import pathlib
import signal
import time

from . import processes
from .protocol import Control, Refused

GROUP_PORT = 7717


class Node:
    """`settings`: lines of YAML for its config, by section. Started from the main thread alone."""

    def __init__(self, bin_dir, control_pb2, work, name, role="robot", settings=None):
        self.name, self.role = name, role
        self.work = pathlib.Path(work)
        self.namespace = self.port = None
        self.ingest, self.socket = self.work / f"{name}.ingest", self.work / f"{name}.control"
        self.log = self.work / f"{name}.log"
        self.life, self._is_starting = 0, False
        self._bin, self._pb = pathlib.Path(bin_dir), control_pb2
        self.settings = dict(settings or {})
        self._process = None
        self._control = self.connect()

    def connect(self, timeout_s=10.0):
        """A connection of one's own, for a thread."""
        return Control(self._pb, self.socket, timeout_s)

    def join(self, key_file, *, namespace=None, port=7718, seeds=(), group_packets=False,
             group_port=GROUP_PORT):
        """Over radio0 of a namespace, or over the loopback interface to seeds."""
        self.namespace, self.port = namespace, port
        where = "radio0" if namespace else "lo"
        mesh = [f"key_file: {key_file}", f"port: {port}", f"group_port: {group_port}",
                "interfaces:", f"  - name: {where}", f"    group_packets: {str(group_packets).lower()}"]
        if seeds:
            mesh.append("    seeds: [" + ", ".join(f"'127.0.0.1:{seed}'" for seed in seeds) + "]")
        self.settings["mesh"] = mesh

    def _config(self):
        sections = {"node": [f"name: {self.name}", f"role: {self.role}"],
                    "sockets": [f"ingest: {{path: {self.ingest}}}",
                                f"control: {{path: {self.socket}}}"],
                    "store": [f"file: {self.work / (self.name + '.db')}"]}
        sections |= self.settings
        if self.role == "base":
            sections["sensors"] = "[]"
        text = ""
        for name, lines in sections.items():
            text += f"{name}: {lines}\n" if isinstance(lines, str) else (
                f"{name}:\n" + "".join(f"  {line}\n" for line in lines))
        path = self.work / f"{self.name}.yaml"
        path.write_text(text)
        return path

    def start(self, wait_s=60.0):
        """Seconds until it answered."""
        self.life, self._is_starting = self.life + 1, True
        before = time.monotonic()
        inside = ["ip", "netns", "exec", self.namespace] if self.namespace else []
        command = [*inside, self._bin / "warrend", "--config", self._config()]
        with open(self.log, "ab") as log:
            self._process = processes.start(command, stderr=log, stdout=log)
        while time.monotonic() < before + wait_s:
            if self._process.poll() is not None:
                raise RuntimeError(f"{self.name} ended with {self._process.returncode}: {self.tail()}")
            try:
                self._control.ask(status={})
                self._is_starting = False
                return time.monotonic() - before
            except OSError:
                time.sleep(0.05)
        raise RuntimeError(f"{self.name} does not answer: {self.tail()}")

    def is_running(self):
        return self._process is not None and self._process.poll() is None

    def is_up(self):
        """It runs, and has answered since it was started."""
        return self.is_running() and not self._is_starting

    def kill(self):
        self._control.close()
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()

    def forget(self):
        """Loses its disk. While it is dead."""
        for file in self.work.glob(f"{self.name}.db*"):
            file.unlink()

    def stop(self, wait_s=30.0):
        """Its exit status."""
        self._control.close()
        return processes.end(self._process, wait_s) if self._process else 0

    def ask(self, **body):
        return self._control.ask(**body)

    def status(self):
        return self.ask(status={})

    def fleet(self):
        return self.ask(fleet_status={})

    def save(self, path, **fields):
        """What it says of the file; None if there is nothing to save."""
        try:
            return self.ask(map_save={"path": str(path)} | fields)
        except Refused:
            return None

    @property
    def pid(self):
        return self._process.pid

    def tail(self, lines=8):
        return "\n".join(self.log.read_text(errors="replace").splitlines()[-lines:])


def make_key(bin_dir, work):
    path = pathlib.Path(work) / "fleet.key"
    processes.run([pathlib.Path(bin_dir) / "warrenctl", "key", "new", path])
    return path
