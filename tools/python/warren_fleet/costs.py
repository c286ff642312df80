# SPDX-License-Identifier: Apache-2.0
"""What a node costs: a base with many robots, a robot that does everything, a start with a large store.
Over the loopback interface, with light robots in one process, so that the machine has room."""
import pathlib
import statistics
import tempfile
import time

from . import protocol
from .busy import Busy
from .driving import World, summary_of
from .fleet import Fleet
from .load import MachineLoad, ProcessLoad
from .node import Node
from .peers import LightPeers

ROBOTS = (5, 20, 50, 100)
REFERENCE = {"map": ["resolution_m: 0.1"], "sensors": ["- name: lidar", "  max_range_m: 20"],
             "layer": ["tick_s: 1"]}
CAVE_M = 250  # of passages; the light robots' tape is of the same cave
LIVES = 5


class Loopback:
    """A base and robots, from their start to their end."""

    def __init__(self, bin_dir, robots):
        self.bin = bin_dir
        self._folder = tempfile.TemporaryDirectory(prefix="warren-bench-", ignore_cleanup_errors=True)
        self.work = pathlib.Path(self._folder.name)
        control_pb2, _ = protocol.make_modules(self.work / "proto")
        self.fleet = Fleet(bin_dir, control_pb2, self.work, robots=robots, settings=REFERENCE)
        self._ends = []

    def __enter__(self):
        try:
            self.fleet.start_on_loopback()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for end in self._ends:
            end()
        self.fleet.close()
        self._folder.cleanup()

    def light_peers(self, bases, **options):
        peers = LightPeers(self.bin, self.work / "fleet.key", bases, length=CAVE_M, **options)
        self._ends.append(peers.end)
        return peers

    def busy(self, node, addressee, rate_hz):
        busy = Busy(node, addressee, rate_hz)
        self._ends.append(busy.stop)
        return busy

    def drive(self, seconds):
        world = World(self.bin, preset="cave", seed=1, seconds=seconds, robots=1, length_m=CAVE_M)
        sim = world.drive([self.fleet.robots[0].ingest], self.work / "sim.log")
        self._ends.append(lambda: sim.poll() is not None or sim.kill())
        return sim


def voxels_held(node):
    """Of others, in the layers as it saves them."""
    file, voxels = node.work / "copy.layer", 0
    for other in node.fleet().nodes:
        if any(not layer.own for layer in other.layers):
            voxels += node.save(file, of=other.name).voxels
            file.unlink()
    return voxels


def at_the_base(bin_dir, quick):
    """Each robot publishes what it would at the reference load, and meets the base alone."""
    for robots in ((5,) if quick else ROBOTS):
        with Loopback(bin_dir, robots=0) as here:
            base = here.fleet.base
            peers = here.light_peers([base], robots=robots, seconds=10 if quick else 60,
                                     tape_s=5 if quick else 30)
            peers.await_line("ready")
            load, machine, before = ProcessLoad(base.pid), MachineLoad(), base.fleet().ip_bytes_in
            peers.await_line("published")
            cost, waited, idle = load.read(), load.waited(), machine.idle_cores()
            came_bytes = base.fleet().ip_bytes_in - before
            said = peers.result()
            yield {"robots": robots, "ticks": said["ticks"], "ticks_late": said["ticks_late"],
                   "base": cost, "base_waited": waited,
                   "kb_per_s_in": came_bytes / 1000 / said["seconds"],
                   "voxels_published": said["voxels"], "voxels_held": voxels_held(base),
                   "digests_equal": said["digests_equal"],
                   "caught_up_after_s": said["caught_up_after_s"],
                   "peers_cores": said["cores"], "idle_cores": idle}


def everything(bin_dir, quick):
    """One robot with all that can be asked of it."""
    seconds = 15 if quick else 120
    with Loopback(bin_dir, robots=1) as here:
        base, robot = here.fleet.base, here.fleet.robots[0]
        peers = here.light_peers([base, robot], robots=2, seconds=seconds + 15,
                                 tape_s=5 if quick else 60)
        peers.await_line("ready")
        busy = here.busy(robot, "base", rate_hz=10.0)
        sim = here.drive(seconds)
        while robot.status().map.scans == 0 and sim.poll() is None:
            time.sleep(0.1)
        load, at_base, machine = ProcessLoad(robot.pid), ProcessLoad(base.pid), MachineLoad()
        sim.wait()
        cost, waited, idle = load.read(), load.waited(), machine.idle_cores()
        base_cost = at_base.read()
        busy.stop()
        summary = summary_of(here.work / "sim.log")
        own = robot.status().map
        said = peers.result()
        yield {"scans_sent": summary["sent"], "scans_taken": summary["taken"],
               "own_voxels": own.voxels_free + own.voxels_occupied,
               "copied_voxels": voxels_held(robot), "digests_equal": said["digests_equal"],
               "map_answers": busy.answers, "map_answers_mb": busy.answer_bytes / 1e6,
               "ground_answers": busy.grounds, "with_ground": busy.grounds_found,
               "messages": busy.messages, "robot": cost, "robot_waited": waited,
               "base": base_cost, "peers_cores": said["cores"], "idle_cores": idle}


def start_again(bin_dir, quick):
    """kill -9 with a large map, then the time to the first answer, in which the whole map has to be."""
    least_bytes = 5e6 if quick else 50e6
    with tempfile.TemporaryDirectory(prefix="warren-bench-", ignore_cleanup_errors=True) as folder:
        work = pathlib.Path(folder)
        control_pb2, _ = protocol.make_modules(work / "proto")
        node = Node(bin_dir, control_pb2, work, "robot-0", "robot", REFERENCE)
        node.start()
        try:
            _map_until(node, work, least_bytes, bin_dir)
            status = node.status()
            took = [_start_after_kill(node, status.map) for _ in range(LIVES)]
            yield {"map_mb": status.map.memory_bytes / 1e6, "blocks": status.map.blocks,
                   "voxels": status.map.voxels_free + status.map.voxels_occupied,
                   "file_mb": status.store.file_bytes / 1e6, "lives": LIVES,
                   "seconds_p50": statistics.median(took), "seconds_most": max(took)}
        finally:
            if node.is_running():
                node.kill()


def _map_until(node, work, least_bytes, bin_dir):
    world = World(bin_dir, preset="cave", seed=1, seconds=3600, robots=1, length_m=2880,
                  speed_m_s=2.0)
    sim = world.drive([node.ingest], work / "sim.log", columns=512, rate_hz=1.0, pace="max")
    while node.status().map.memory_bytes < least_bytes:
        if sim.poll() is not None:
            raise RuntimeError("the drive ended before the map was large enough")
        time.sleep(0.25)
    sim.kill()
    sim.wait()
    node.ask(layer_flush={})
    time.sleep(3.0)
    while node.status().store.batches_queued > 0:
        time.sleep(0.25)


def _start_after_kill(node, before):
    node.kill()
    seconds = node.start()
    after = node.status().map
    for count in ("scans", "blocks", "voxels_free", "voxels_occupied"):
        if getattr(after, count) != getattr(before, count):
            raise RuntimeError(f"{count}: {getattr(before, count)} before the kill, "
                               f"{getattr(after, count)} after it")
    return seconds
