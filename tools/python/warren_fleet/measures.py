# SPDX-License-Identifier: Apache-2.0
"""Numbers and curves out of what was observed."""
import bisect


def percentile(values, share):
    """None of nothing; the nearest rank otherwise."""
    if not values:
        return None
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def lags(ledger, from_s, until_s):
    """(time, layer, seconds): how long ago the first revision that the base lacks was published, by
    the observer's clock and not by what the base knows of it. 0: it has all."""
    found = []
    for now, layer, held in ledger.held_at_base:
        if not from_s <= now <= until_s:
            continue
        history = ledger.first_told.get(layer, [])
        lacking = bisect.bisect_right([revision for _, revision in history], held)
        is_late = lacking < len(history) and history[lacking][0] < now
        found.append((now, layer, now - history[lacking][0] if is_late else 0.0))
    return found


def first_lags(ledger, from_s, until_s):
    """The same of layers of which the base has nothing at all: it does not speak of these. At every
    moment at which it answered."""
    told = {}
    for now, layer, _ in ledger.held_at_base:
        told.setdefault(layer, now)
    moments = [now for now, node in ledger.answers
               if node == "base" and from_s <= now <= until_s]
    return [(now, layer, now - history[0][0])
            for layer, history in ledger.first_told.items()
            for now in moments if history[0][0] < now < told.get(layer, float("inf"))]


def coverage(ledger):
    """(curve at the base, curve of the robots together): (time, share of what all robots have mapped
    at the end). The base is taken to know what the writer knew at the revision that the base holds."""
    end = sum(history[-1][2] for history in ledger.mapped.values())
    own = sorted((now, layer, voxels) for layer, history in ledger.mapped.items()
                 for now, _, voxels in history)
    base = [(now, layer, _voxels_at(ledger.mapped.get(layer, []), held))
            for now, layer, held in ledger.held_at_base]
    return _shares(base, end), _shares(own, end)


def _voxels_at(history, held):
    place = bisect.bisect_right([revision for _, revision, _ in history], held)
    return history[place - 1][2] if place > 0 else 0


def _shares(changes, end):
    latest, curve = {}, []
    for now, layer, voxels in changes:
        latest[layer] = voxels
        curve.append((now, sum(latest.values()) / end))
    return curve


class Rates:
    """kB (1000 bytes) a second that each node put on the air, second by second, from the emulator's
    counts: a kill resets none of them."""

    def __init__(self, names):
        self._names, self._last = names, None
        self.samples = []  # (time, node, kB/s)

    def note(self, now, stats):
        bytes_now = [node["sent_bytes"] for node in stats["nodes"]]
        if self._last is not None:
            for name, before, after in zip(self._names, self._last[1], bytes_now):
                self.samples.append((now, name, (after - before) / 1000.0 / (now - self._last[0])))
        self._last = (now, bytes_now)

    def of(self, names, from_s, until_s):
        return [rate for now, name, rate in self.samples
                if name in names and from_s <= now <= until_s]
