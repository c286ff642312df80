# SPDX-License-Identifier: Apache-2.0
"""A base and robots: behind emulated radios, or over the loopback interface."""
import os
import pathlib

from .link import Link
from .node import Node, make_key

_PORTS = 64  # of a fleet on the loopback interface: its group's, then one for each node


class Fleet:
    """`nodes`: the base, then the robots, robot-0.. From the main thread alone."""

    def __init__(self, bin_dir, control_pb2, work, *, robots, settings):
        self.bin, self.work = pathlib.Path(bin_dir), pathlib.Path(work)
        self.base = Node(bin_dir, control_pb2, work, "base", "base", settings)
        self.robots = [Node(bin_dir, control_pb2, work, f"robot-{i}", "robot", settings)
                       for i in range(robots)]
        self.nodes = [self.base, *self.robots]
        self.link = None

    def start_in_namespaces(self, link_options, *, group_packets=False):
        self.link = Link(self.bin / "warren-link", len(self.nodes), link_options,
                         self.work / "link.log")
        key = make_key(self.bin, self.work)
        for node, namespace in zip(self.nodes, self.link.namespaces):
            node.join(key, namespace=namespace, group_packets=group_packets)
            node.start()

    def start_on_loopback(self):
        """Everybody seeks the base by its address. Ports are of this process."""
        key = make_key(self.bin, self.work)
        group = 10000 + os.getpid() % 300 * _PORTS
        for number, node in enumerate(self.nodes, start=1):
            node.join(key, port=group + number, group_port=group,
                      seeds=[group + 1] if number > 1 else [])
            node.start()

    def close(self):
        """The emulator's last counts, if there is one."""
        for node in self.nodes:
            if node.is_running():
                node.kill()
        counts = self.link.close() if self.link is not None else None
        self.link = None
        return counts
