# SPDX-License-Identifier: Apache-2.0
"""The fleet of a soak: a base, robots and their drivers behind a radio that is as bad as the world
says and worse."""
import random

from warren_fleet import radio
from warren_fleet.driving import World
from warren_fleet.fleet import Fleet
from warren_fleet.relay import Relay
from warren_fleet.scans import Recording

LEAD_S = 12.0          # from the radio's start to the robots' first scan, about
LOSS = 0.15            # of packets, besides what the world's radio loses
RATE_BIT_S = 1e6
SENSOR_COLUMNS, SENSOR_RATE_HZ = 256, 2.0
TICK_S = 1.0
SETTINGS = {"layer": [f"tick_s: {TICK_S}", "flush_after_s: 5"],
            "sensors": ["- name: lidar", "  max_range_m: 15.0"],
            "map": ["resolution_m: 0.15"]}


class Scene:
    """`hermit`: the robot that only ever meets one other robot. `out`: a folder with room for all
    scans. From the main thread alone."""

    def __init__(self, bin_dir, modules, work, out, *, minutes, robots, seed):
        self.bin, self.work, self.seconds = bin_dir, work, 60.0 * minutes
        self._out = out
        control_pb2, self._ingest_pb2 = modules
        self._random = random.Random(seed)
        self._group_packets = seed % 2 == 0
        self.world = World(bin_dir, preset="cave", seed=seed, seconds=self.seconds, robots=robots,
                           length_m=max(250, round(50 * minutes)), stagger_s=5.0)
        self.fleet = Fleet(bin_dir, control_pb2, work, robots=robots, settings=SETTINGS)
        self.nodes, self.robots, self.base = self.fleet.nodes, self.fleet.robots, self.fleet.base
        self.hermit = (self.robots[-1].name, self.robots[0].name) if robots > 1 else None
        self.relays, self.recordings, self._sim = [], [], None

    def blackouts(self):
        """All radios for a tenth of the time; later the base's alone, then one robot's."""
        robot = self._random.choice(self.robots).name
        blackouts = []
        for start, length, node in ((0.2, 0.1, None), (0.45, 0.15, "base"), (0.7, 0.15, robot)):
            start_s = LEAD_S + self.seconds * (start + 0.1 * self._random.random())
            blackouts.append(radio.Blackout(start_s, start_s + self.seconds * length, node))
        return blackouts

    def start(self):
        self.fleet.start_in_namespaces(
            ["--trace", self._trace(), "--delay-ms", "5", "--queue-ms", "400",
             "--neighbour-retry-ms", "100", "--seed", self.world.seed],
            group_packets=self._group_packets)
        for robot in self.robots:
            self.recordings.append(Recording(self._out))
            self.relays.append(Relay(self._ingest_pb2, robot, self.recordings[-1]))

    def _trace(self):
        rows = radio.read(self.world.radio(self.work))
        end_s = LEAD_S + self.seconds + 1.0
        worsened = radio.worsened(rows, delay_s=LEAD_S, loss=LOSS, blackouts=self.blackouts(),
                                  hermit=self.hermit)
        healed = radio.healed(rows, at_s=end_s, loss=LOSS, rate_bit_s=RATE_BIT_S, hermit=self.hermit)
        trace = [row for row in worsened if row.time_s < end_s] + list(healed)
        path = self.work / "trace.csv"
        radio.write(path, sorted(trace, key=lambda row: row.time_s))
        return path

    def drive(self):
        self._sim = self.world.drive([relay.socket for relay in self.relays], self.work / "sim.log",
                                     columns=SENSOR_COLUMNS, rate_hz=SENSOR_RATE_HZ)

    def is_driving(self):
        return self._sim.poll() is None

    def relay_of(self, node):
        return next((relay for relay in self.relays if relay.node is node), None)

    def close(self):
        if self._sim is not None and self._sim.poll() is None:
            self._sim.kill()
            self._sim.wait()
        for relay in self.relays:
            relay.close()
        for recording in self.recordings:
            recording.close()
        self.fleet.close()
