#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""The soak's own judgement: what is wrong must be found, what is right must not."""
import pathlib
import struct
import sys
import tempfile
import threading
import unittest
from types import SimpleNamespace as Record

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/python"), str(ROOT / "tests/soak")]
sys.dont_write_bytecode = True

import audit  # noqa: E402
import octree  # noqa: E402
from killer import Killer  # noqa: E402
from warren_fleet import measures, radio  # noqa: E402
from warren_fleet.ledger import Ledger, Observer  # noqa: E402
from warren_fleet.protocol import Refused  # noqa: E402
from warren_fleet.scans import Scan  # noqa: E402

LAYER = Record(origin=7, number=0, incarnation=1)
KEY = (7, 0, 1)


def status(revision, digest, queued=0):
    own = Record(layer=LAYER, revision=revision, digest=digest, HasField=lambda _: True)
    return Record(publishing=own, loaded=[], store=Record(batches_queued=queued),
                  map=Record(voxels_free=1, voxels_occupied=1))


def fleet(held, digest_equal=None, latest=None):
    layer = Record(layer=LAYER, own=False, held_everywhere=held, held_somewhere=held,
                   latest=latest or held, digest_equal=digest_equal,
                   HasField=lambda _: digest_equal is not None)
    return Record(nodes=[Record(name="robot-0", layers=[layer])], sent=[])


class Ledgers(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.ledger = Ledger(pathlib.Path(folder.name) / "ledger.jsonl")
        self.addCleanup(self.ledger.close)

    def lost(self, revision):
        findings = audit.Findings()
        audit.check_revisions([Record(status=lambda: status(revision, "b"))], self.ledger, findings)
        return findings.acked_lost

    def test_a_revision_that_another_holds_may_not_be_missing(self):
        self.ledger.note_fleet(1.0, "base", fleet(5))
        self.assertEqual((self.lost(5), self.lost(3)), (0, 2))

    def test_a_revision_counts_as_stored_only_if_its_node_lived_on(self):
        self.ledger.note_status(1.0, "robot-0", status(5, "a"))
        self.ledger.note_life("robot-0")
        self.ledger.note_status(9.0, "robot-0", status(4, "b"))
        self.assertEqual(self.lost(4), 0)
        self.ledger.note_status(12.0, "robot-0", status(4, "b"))
        self.assertEqual((self.lost(4), self.lost(3)), (0, 1))

    def test_a_revision_does_not_count_as_stored_while_the_disk_is_behind(self):
        self.ledger.note_status(1.0, "robot-0", status(5, "a", queued=1))
        self.ledger.note_status(9.0, "robot-0", status(5, "a", queued=1))
        self.assertEqual(self.lost(4), 0)

    def test_a_revision_that_was_two_maps_is_found(self):
        for now, digest in ((1.0, "a"), (4.0, "b"), (7.0, "b")):
            self.ledger.note_status(now, "robot-0", status(5, digest))
        self.assertEqual(self.lost(5), 1)

    def test_a_copy_that_differs_is_found_once(self):
        for now in (1.0, 2.0):
            self.ledger.note_fleet(now, "base", fleet(5, digest_equal=False))
        self.assertEqual(self.lost(5), 1)

    def test_coverage_at_the_base_is_what_the_writer_knew_at_its_revision(self):
        for now in range(4):
            answer = status(now + 1, "a")
            answer.map.voxels_free = 10 * now + 9
            self.ledger.note_status(float(now), "robot-0", answer)
            self.ledger.note_fleet(now + 0.5, "base", fleet(2))
        base, own = measures.coverage(self.ledger)
        self.assertEqual((base[-1][1], own[-1][1]), (0.5, 1.0))

    def test_lag_is_told_by_what_the_writer_published_and_the_base_had(self):
        for now in range(10):
            self.ledger.note_status(float(now), "robot-0", status(now + 1, "a"))
            self.ledger.note_fleet(now + 0.5, "base", fleet(3))
        found = {now: lag for now, _, lag in measures.lags(self.ledger, 0.0, 99.0)}
        self.assertEqual((found[2.5], found[3.5], found[9.5]), (0.0, 0.5, 6.5))


class Scans(unittest.TestCase):
    def judge(self, taken, killed_at):
        relay = Record(socket=pathlib.Path("robot-0.driver"), faults=[],
                       lost=[(1, Scan(4, 0, 0, taken), killed_at)])
        findings = audit.Findings()
        audit.check_scans([relay], 2.0, findings)
        return findings.acked_lost

    def test_only_scans_of_the_last_ticks_may_be_lost(self):
        self.assertEqual(self.judge(10.0, 11.9), 0)
        self.assertEqual(self.judge(10.0, 12.1), 1)

    def test_scans_without_a_receipt_may_be_lost(self):
        self.assertEqual(self.judge(None, 99.0), 0)

    def test_no_scan_may_be_lost_without_a_kill(self):
        self.assertEqual(self.judge(10.0, None), 1)


def tree(*nodes):
    head = b"# Octomap OcTree file\nid OcTree\nsize %d\nres 0.1\ndata\n" % len(nodes)
    return octree.Tree(head + b"".join(struct.pack("<fB", *node) for node in nodes))


class Trials(unittest.TestCase):
    """What a soak must have done for its verdict to mean anything."""

    def notes(self, *, kills=1, seconds=120.0, accepted=1, scans=(1, 1)):
        killer = Killer(None, 60.0, 1, None)
        killer.kills = [(0.0, "base")] * kills
        relays = [Record(node=Record(name=f"robot-{i}"), sent=[None] * count)
                  for i, count in enumerate(scans)]
        findings = audit.Findings()
        audit.check_tried(killer, seconds, {1: None} if accepted else {}, relays, findings)
        return findings.notes

    def test_all_was_tried(self):
        self.assertEqual(self.notes(), [])

    def test_without_a_kill_it_fails_if_there_was_time_for_one(self):
        self.assertEqual(len(self.notes(kills=0)), 1)
        self.assertEqual(self.notes(kills=0, seconds=30.0), [])

    def test_without_a_message_or_a_robot_s_scans_it_fails(self):
        self.assertEqual(len(self.notes(accepted=0)), 1)
        self.assertEqual(len(self.notes(scans=(0, 1))), 1)

    def heard(self, answered, unanswered, life=2, broke=False):
        observer = Record(node=Record(name="base", life=life), answered=answered,
                          unanswered=unanswered, broke=broke)
        findings = audit.Findings()
        audit.check_answers([observer], findings)
        return findings.notes == []

    def test_a_question_for_each_kill_and_three_more_may_be_unanswered(self):
        self.assertTrue(self.heard(100, 5))
        self.assertFalse(self.heard(100, 6))

    def test_an_observer_that_heard_nothing_or_broke_off_is_no_witness(self):
        self.assertFalse(self.heard(0, 0))
        self.assertFalse(self.heard(100, 0, broke=True))


class Asked:
    """A node that answers every question by an error, and says that it is up, or not."""
    name, life = "base", 1

    def __init__(self, error, up):
        self.error, self.up, self.asked = error, up, threading.Event()

    def connect(self, timeout_s):
        return self

    def ask(self, **_):
        self.asked.set()
        raise self.error

    def is_up(self):
        return self.up

    def close(self):
        pass


class Observers(unittest.TestCase):
    def observe(self, error, up):
        node = Asked(error, up)
        observer = Observer(node, None)
        self.assertTrue(node.asked.wait(10.0))
        observer.stop()
        return observer

    def test_only_questions_to_a_node_that_is_up_count_as_unanswered(self):
        for error in (ConnectionRefusedError(), Refused("no")):
            self.assertGreaterEqual(self.observe(error, up=True).unanswered, 1)
            self.assertEqual(self.observe(error, up=False).unanswered, 0)

    def test_an_observer_that_ends_by_itself_is_found(self):
        observer = Observer(Asked(SystemExit(), up=True), None)
        observer._thread.join(10.0)
        observer.stop()
        observer.stop()
        self.assertTrue(observer.broke)


class Octrees(unittest.TestCase):
    """Roots of 2x2x2 children that stand for 8^15 voxels each."""
    CHILD = 8 ** 15

    def test_equal_trees_are_equal(self):
        self.assertEqual(octree.count_different(tree((1.0, 3), (1.0, 0), (-1.0, 0)),
                                                tree((1.0, 3), (1.0, 0), (-1.0, 0))), 0)

    def test_a_voxel_known_to_one_alone_differs(self):
        self.assertEqual(octree.count_different(tree((1.0, 3), (1.0, 0), (-1.0, 0)),
                                                tree((1.0, 1), (1.0, 0))), self.CHILD)

    def test_other_log_odds_differ(self):
        self.assertEqual(octree.count_different(tree((1.0, 1), (1.0, 0)),
                                                tree((1.0, 1), (0.5, 0))), self.CHILD)

    def test_a_pruned_node_is_compared_with_each_child(self):
        self.assertEqual(octree.count_different(tree((1.0, 0)), tree((1.0, 3), (1.0, 0), (2.0, 0))),
                         7 * self.CHILD)

    def test_everything_differs_from_an_empty_map(self):
        self.assertEqual(octree.count_different(octree.Tree(octree.EMPTY),
                                                tree((1.0, 1), (1.0, 0))), self.CHILD)


class Radios(unittest.TestCase):
    ROWS = [radio.Row(time, sender, receiver, 0.0, 1e6) for time in (0.0, 1.0, 2.0)
            for sender in ("base", "a", "b") for receiver in ("base", "a", "b")
            if sender != receiver]

    def test_a_hermit_meets_one_other_alone(self):
        rows = [*radio.worsened(self.ROWS, delay_s=5.0, loss=0.1, blackouts=[], hermit=("b", "a")),
                *radio.healed(self.ROWS, at_s=9.0, loss=0.1, rate_bit_s=1e6, hermit=("b", "a"))]
        for row in rows:
            apart = {row.sender, row.receiver} == {"b", "base"}
            self.assertAlmostEqual(row.loss, 1.0 if apart else 0.1)

    def test_a_blackout_takes_all_or_those_of_one_node(self):
        for node, silent in ((None, 6), ("a", 4)):
            blackout = radio.Blackout(5.5, 6.5, node)
            rows = radio.worsened(self.ROWS, delay_s=5.0, loss=0.1, blackouts=[blackout])
            self.assertEqual(sum(row.loss == 1.0 for row in rows), silent)


if __name__ == "__main__":
    unittest.main()
