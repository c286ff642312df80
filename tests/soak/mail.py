# SPDX-License-Identifier: Apache-2.0
"""Messages of applications, from anybody to anybody: what was accepted has to arrive, however often both
are killed."""
import random
import threading

from warren_fleet.protocol import Refused

_EVERY_S = 2.0


class Mail:
    """`accepted`: number -> (from, to); `arrived`: the numbers that each node's application read."""

    def __init__(self, nodes, seed):
        self._nodes, self._random = nodes, random.Random(seed + 2)
        self.accepted, self.arrived = {}, {node.name: set() for node in nodes}
        self.refused = 0
        self._stopped = {"send": threading.Event(), "read": threading.Event()}
        self._threads = [threading.Thread(target=self._send, daemon=True),
                         *(threading.Thread(target=self._read, args=(node,), daemon=True)
                           for node in nodes)]
        for thread in self._threads:
            thread.start()

    def _send(self):
        number = 0
        while not self._stopped["send"].wait(_EVERY_S):
            number += 1
            sender, receiver = self._random.sample(self._nodes, 2)
            control = sender.connect(5.0)
            try:
                control.ask(message_send={"to": receiver.name, "content": b"soak %d" % number})
                self.accepted[number] = (sender.name, receiver.name)
            except OSError:
                pass  # killed: nobody was told that it is accepted
            except Refused:
                self.refused += 1  # e.g. nobody called so has been heard of yet
            finally:
                control.close()

    def _read(self, node):
        control, inbox, after = node.connect(5.0), 0, 0
        while not self._stopped["read"].wait(0.5):
            try:
                answer = control.ask(message_watch={"inbox": inbox, "after": after})
            except (OSError, Refused):
                continue
            inbox, after = answer.inbox, answer.next
            for message in answer.messages:
                word, number = bytes(message.content).split()
                assert word == b"soak"
                self.arrived[node.name].add(int(number))
        control.close()

    def stop_sending(self):
        self._stopped["send"].set()
        self._threads[0].join(10.0)

    def missing(self):
        return [(number, *pair) for number, pair in sorted(self.accepted.items())
                if number not in self.arrived[pair[1]]]

    def stop(self):
        self.stop_sending()
        self._stopped["read"].set()
        for thread in self._threads:
            thread.join(10.0)
