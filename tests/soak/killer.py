# SPDX-License-Identifier: Apache-2.0
"""kill -9, again and again: everybody in turn, in an order of its own each round."""
import random
import time

_TURN_S = 5.0  # between two turns, at most

class Killer:
    """`forgetful`: a planted fault, every kill takes the store with it."""

    def __init__(self, scene, every_s, seed, observe, forgetful=False):
        self._scene, self._every_s, self._observe = scene, every_s, observe
        self._forgetful = forgetful
        self._random = random.Random(seed + 1)
        self._round = []
        self._next = time.time() + 0.5 * every_s
        self._dead = []     # (when to start again, node)
        self.kills = []     # (time, node's name)
        self.crashes = []   # of daemons that ended by themselves
        self.slowest_start_s = 0.0

    def turn(self, may_kill=True):
        now = time.time()
        for entry in [entry for entry in self._dead if entry[0] <= now]:
            self._dead.remove(entry)
            self.slowest_start_s = max(self.slowest_start_s, entry[1].start())
            self._observe(f"{entry[1].name} is back")
        for node in self._scene.nodes:
            if not node.is_running() and node not in (dead for _, dead in self._dead):
                self.crashes.append(f"{node.name} ended by itself: {node.tail()}")
                self._dead.append((now, node))
        if may_kill and now >= self._next:
            self._next += self._every_s
            self._kill(now)

    def _kill(self, now):
        if not self._round:
            self._round = self._random.sample(self._scene.nodes, len(self._scene.nodes))
        node = self._round.pop()
        if not node.is_running():
            return
        relay = self._scene.relay_of(node)
        if relay is not None:
            relay.killed_at = now
        node.kill()
        if self._forgetful:
            node.forget()
        self.kills.append((now, node.name))
        self._dead.append((now + self._random.uniform(0.2, 4.0), node))
        self._observe(f"kill -9 {node.name}")

    def is_due(self, seconds):
        """Whether so long a run has time for a kill."""
        return seconds > 0.5 * self._every_s + _TURN_S

    def revive_all(self):
        while self._dead:
            self.turn(may_kill=False)
            time.sleep(0.1)
