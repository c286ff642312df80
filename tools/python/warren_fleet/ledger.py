# SPDX-License-Identifier: Apache-2.0
"""What an outside observer was told by every node, when: the only memory that no kill reaches."""
import json
import threading
import time

from .protocol import Refused

_EVERY_S = 0.5
# What a node tells of itself is taken for acknowledged once it lived on for so long with nothing
# waiting for the disk; what another node tells of it, at once.
_STORED_AFTER_S = 2.0


def key_of(layer):
    return (layer.origin, layer.number, layer.incarnation)


class Ledger:
    """Lines of JSON in a file, and the sums that the end is compared with."""

    def __init__(self, path):
        self._file = open(path, "w")
        self._lock = threading.Lock()
        self.acknowledged = {}     # layer -> revision
        self.digests = {}          # (layer, revision) -> digest, of those acknowledged
        self.faults = {}           # each once
        self.first_told = {}       # layer -> [(time, revision)], rising
        self.held_at_base = []     # (time, layer, revision)
        self.answers = []          # (time, node)
        self.mapped = {}           # layer -> [(time, revision, voxels of the self-map)], rising
        self.classes = {}          # node -> {class: bytes}, over its lives
        self._told = {}            # node -> [(time, layer, revision, digest)], not yet acknowledged

    def note(self, record):
        with self._lock:
            self._file.write(json.dumps({"t": round(time.time(), 3)} | record) + "\n")

    def note_life(self, node):
        """A new life of a node: what it told last may never have been stored."""
        with self._lock:
            self._told.pop(node, None)

    def note_status(self, now, node, status):
        own = status.publishing
        voxels = status.map.voxels_free + status.map.voxels_occupied
        with self._lock:
            self.answers.append((now, node))
            if not own.HasField("layer"):
                return
            layer = key_of(own.layer)
            history = self.first_told.setdefault(layer, [])
            if not history or own.revision > history[-1][1]:
                history.append((now, own.revision))
                self.mapped.setdefault(layer, []).append((now, own.revision, voxels))
            told = self._told.setdefault(node, [])
            told.append((now, layer, own.revision, own.digest))
            if status.store.batches_queued == 0:
                while told and told[0][0] <= now - _STORED_AFTER_S:
                    self._acknowledge(*told.pop(0)[1:])

    def note_fleet(self, now, node, fleet):
        with self._lock:
            for other in fleet.nodes:
                for layer in other.layers:
                    key = key_of(layer.layer)
                    if layer.own:
                        continue
                    self._acknowledge(key, layer.held_somewhere, None)
                    if node == "base":
                        self.held_at_base.append((now, key, layer.held_everywhere))
                    if layer.HasField("digest_equal") and not layer.digest_equal:
                        self._blame(f"{node} has another digest of {other.name}'s layer {key} "
                                    f"at revision {layer.latest}")

    def note_sent(self, node, before, fleet):
        """Adds what it sent by class since `before`, its last counts in this life."""
        now = {each.name: each.bytes for each in fleet.sent}
        with self._lock:
            sums = self.classes.setdefault(node, {})
            for name, count in now.items():
                sums[name] = sums.get(name, 0) + count - before.get(name, 0)
        return now

    def _acknowledge(self, layer, revision, digest):
        self.acknowledged[layer] = max(revision, self.acknowledged.get(layer, 0))
        if digest is None:
            return
        known = self.digests.setdefault((layer, revision), digest)
        if known != digest:
            self._blame(f"revision {revision} of layer {layer} was two different maps")

    def _blame(self, text):
        self.faults[text] = None

    def close(self):
        self._file.close()


class Observer:
    """Asks one node for its status again and again, through its deaths."""

    def __init__(self, node, ledger):
        self.node, self._ledger = node, ledger
        self._control = node.connect(timeout_s=5.0)
        self._stopped = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.answered = 0
        self.unanswered = 0  # questions, though the node had answered in this life
        self.broke = False   # it ended by itself
        self._thread.start()

    def _run(self):
        sent, life = {}, 0
        while not self._stopped.wait(_EVERY_S):
            try:
                status, fleet = self._control.ask(status={}), self._control.ask(fleet_status={})
            except (OSError, Refused):
                self.unanswered += self.node.is_up()
                continue
            now = time.time()
            self.answered += 1
            if life != self.node.life:
                life, sent = self.node.life, {}
                self._ledger.note_life(self.node.name)
            self._ledger.note_status(now, self.node.name, status)
            self._ledger.note_fleet(now, self.node.name, fleet)
            sent = self._ledger.note_sent(self.node.name, sent, fleet)
            self._ledger.note(_record(self.node, status, fleet))

    def stop(self):
        self.broke |= not self._stopped.is_set() and not self._thread.is_alive()
        self._stopped.set()
        self._thread.join(15.0)
        self._control.close()


def _record(node, status, fleet):
    own = status.publishing
    return {"node": node.name, "life": node.life, "scans": status.map.scans,
            "own": [*key_of(own.layer), own.revision, own.digest] if own.HasField("layer") else None,
            "holds": [[*key_of(layer.layer), layer.held_everywhere, layer.latest]
                      for other in fleet.nodes for layer in other.layers if not layer.own]}
