# SPDX-License-Identifier: Apache-2.0
"""What is true at the end, compared with what the ledger and the lidars' drivers remember."""
import dataclasses
import time

import octree
from warren_fleet import scans
from warren_fleet.agreement import digests_of
from warren_fleet.ledger import key_of
from warren_fleet.node import Node

# Questions that may go without an answer: one that a kill cut off in each life, and a few more when the
# machine is busy, as each waits for 5 s.
UNANSWERED_MAX = 3
PUBLISHED_S = 3.0  # after the last scan: a flush takes what ticks have left, and no more


@dataclasses.dataclass
class Findings:
    digests_equal: bool = True
    contaminated_voxels: int = 0
    acked_lost: int = 0
    notes: list = dataclasses.field(default_factory=list)

    def blame(self, text):
        self.notes.append(text)


def check_tried(killer, seconds, accepted, relays, findings):
    """Nothing can be lost where nothing was done."""
    if not killer.kills and killer.is_due(seconds):
        findings.blame("nobody was killed")
    if not accepted:
        findings.blame("no message was accepted")
    for relay in relays:
        if not relay.sent:
            findings.blame(f"{relay.node.name} mapped no scan")


def check_answers(observers, findings):
    """An observer that hears nothing finds nothing."""
    for observer in observers:
        node = observer.node
        if observer.broke or observer.answered == 0:
            findings.blame(f"the observer of {node.name} broke off after {observer.answered} answers")
        if observer.unanswered > node.life + UNANSWERED_MAX:
            findings.blame(f"{node.name} left {observer.unanswered} questions unanswered in "
                           f"{node.life} lives, {observer.answered} were answered")


def check_digests(bin_dir, nodes, robots, work, findings):
    """Not by the daemons' word: every copy is saved, and its digest computed from the file."""
    for robot in robots:
        digests = digests_of(bin_dir, nodes, robot, work)
        if len(set(digests.values())) != 1 or robot.status().publishing.digest not in digests.values():
            findings.digests_equal = False
            findings.blame(f"digests of {robot.name}'s layer: {digests}")


def check_revisions(robots, ledger, findings):
    """Every revision that was acknowledged is part of what its writer has now."""
    now = {key_of(robot.status().publishing.layer): robot for robot in robots}
    for key, revision in ledger.acknowledged.items():
        has = now[key].status().publishing.revision if key in now else 0
        if has < revision:
            findings.acked_lost += revision - has
            findings.blame(f"of layer {key} revision {revision} was acknowledged, {has} is left")
    findings.acked_lost += len(ledger.faults)
    for fault in ledger.faults:
        findings.blame(fault)


def check_scans(relays, allowance_s, findings):
    """Of scans said to be TAKEN, only those of the last ticks before a kill may be lost."""
    oldest_s = 0.0
    for relay in relays:
        for life, scan, killed_at in relay.lost:
            if scan.taken is None:
                continue
            age_s = killed_at - scan.taken if killed_at is not None else float("inf")
            oldest_s = max(oldest_s, age_s)
            if age_s > allowance_s:
                findings.acked_lost += 1
                findings.blame(f"{relay.socket.stem}, life {life}: scan {scan.sequence} was taken "
                               f"{age_s:.1f} s before the kill and is lost")
        for fault in relay.faults:
            findings.acked_lost += 1
            findings.blame(fault)
    return oldest_s


def check_self_map(bin_dir, control_pb2, ingest_pb2, robot, relay, recording, work, findings):
    """The robot's self-map, and what it published, against those of a fresh daemon without a mesh
    that was given the same scans. How many voxels differ."""
    lone = Node(bin_dir, control_pb2, work, f"lone-{robot.name}", settings=robot_settings(robot))
    try:
        lone.start()
        taken = scans.replay(lone.ingest, ingest_pb2, recording, relay.sent)
        if taken != len(relay.sent):
            findings.blame(f"of {len(relay.sent)} scans of {robot.name} {taken} were taken again")
        time.sleep(PUBLISHED_S)
        if taken:
            lone.ask(layer_flush={})
        digests = [node.status().publishing.digest for node in (robot, lone)]
        files = [work / f"{node.name}.ot" for node in (robot, lone)]
        for node, file in zip((robot, lone), files):
            if node.save(file) is None:
                file.write_bytes(octree.EMPTY)
        different = octree.count_different(*map(octree.read, files))
        for file in files:
            file.unlink(missing_ok=True)
        if different == 0 and digests[0] != digests[1]:
            different = 1
            findings.blame(f"{robot.name}: occupancy is as it should be, costs or the published "
                           f"layer are not: {digests}")
        elif different:
            findings.blame(f"{robot.name}: {different} voxels are not what its own scans make")
        findings.contaminated_voxels += different
    finally:
        lone.stop()


def robot_settings(robot):
    return {name: lines for name, lines in robot.settings.items() if name not in ("mesh", "store")}
