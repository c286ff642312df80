# SPDX-License-Identifier: Apache-2.0
"""A base and robots: behind emulated radios, or over the loopback interface."""
import pathlib

from .link import Link
from .node import GROUP_PORT, Node, make_key

FIRST_PORT = 7718


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

    def start_on_loopback(self, first_port=FIRST_PORT):
        """Everybody seeks the base by its address."""
        key = make_key(self.bin, self.work)
        for number, node in enumerate(self.nodes):
            node.join(key, port=first_port + number, seeds=[first_port] if number else [],
                      group_port=GROUP_PORT)
            node.start()

    def close(self):
        """The emulator's last counts, if there is one."""
        for node in self.nodes:
            if node.is_running():
                node.kill()
        counts = self.link.close() if self.link is not None else None
        self.link = None
        return counts
