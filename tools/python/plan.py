#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plans a way over the ground that a fleet has mapped: subscribes to the merge-map of a running
warrend, takes the voxels that a robot could stand on for a graph, and searches it from the robot to a
goal, again whenever the map has changed. See warren_map.py for what it needs.

A robot may stand on an occupied voxel with room above it if under its round footprint nothing stands
in the way, the ground is known but for --unknown of it, and as easy as the thresholds of the daemon's
`ground` query want: costs of at most 0.20, and 0.10 in the mean."""
import argparse
import heapq
import math
import struct
import sys
import time
import zlib

import control_pb2 as pb
from warren_map import BLOCK, Control, MapCopy, OCCUPIED, Refused, cost_of, is_stair, state_of

NEIGHBOURS = [(dx, dy) for dx in (-1, 0, 1) for dy in (-1, 0, 1) if (dx, dy) != (0, 0)]
OCCUPIED_MARKS = bytes(1 if state_of(code & 127) == OCCUPIED else 0 for code in range(256))


class Robot:
    """What it can do, in voxels."""

    def __init__(self, options, resolution):
        radius = options.radius / resolution
        reach = range(-int(radius), int(radius) + 1)
        self.footprint = [(dx, dy) for dx in reach for dy in reach if math.hypot(dx, dy) <= radius]
        self.step = int(options.step / resolution + 1e-6)
        self.height = math.ceil(options.height / resolution - 1e-6)
        self.unknown = options.unknown
        self.max_cost, self.mean_cost = options.max_cost, options.mean_cost
        self.climbs_stairs = options.stairs


class Terrain:
    """The ground of a map copy: nodes are keys of voxels that something can stand on."""

    def __init__(self, copy, robot):
        self.robot = robot
        self.columns = occupied_columns(copy)
        self.tops = {xy: tops_of(column, robot.height) for xy, column in self.columns.items()}
        self._costs = {}

    def near(self, x, y, z):
        """The ground of that column within a step of z; None if there is none."""
        within = [top for top in self.tops.get((x, y), ()) if abs(top - z) <= self.robot.step]
        return min(within, key=lambda top: abs(top - z)) if within else None

    def cost(self, node):
        """Mean cost under a robot there; None if it cannot be there."""
        if node not in self._costs:
            self._costs[node] = self._judge(*node)
        return self._costs[node]

    def _judge(self, x, y, z):
        robot, total, known = self.robot, 0.0, 0
        for dx, dy in robot.footprint:
            column = self.columns.get((x + dx, y + dy), {})
            if any(above in column for above in range(z + robot.step + 1, z + robot.height + 1)):
                return None
            top = self.near(x + dx, y + dy, z)
            if top is None:
                continue
            cost = 0.0 if robot.climbs_stairs and is_stair(column[top]) else cost_of(column[top])
            if cost is None:
                continue
            if cost > robot.max_cost:
                return None
            total, known = total + cost, known + 1
        unknown = len(robot.footprint) - known
        # What is put up with counts as impossible in the mean even then, as it does for the daemon.
        mean = (total + unknown) / len(robot.footprint)
        if unknown > len(robot.footprint) * robot.unknown or mean > robot.mean_cost:
            return None
        return mean

    def next_to(self, node):
        x, y, z = node
        for dx, dy in NEIGHBOURS:
            top = self.near(x + dx, y + dy, z)
            if top is not None:
                yield (x + dx, y + dy, top)

    def nearest(self, key, most):
        """Where a robot can be, closest to that key and at most so far off, in voxels."""
        reach = range(-most, most + 1)
        around = sorted((math.dist(key, (key[0] + dx, key[1] + dy, top)), (key[0] + dx, key[1] + dy, top))
                        for dx in reach for dy in reach for top in self.tops.get((key[0] + dx, key[1] + dy), ()))
        return next((node for far, node in around if far <= most and self.cost(node) is not None), None)


def occupied_columns(copy):
    columns = {}
    for (bx, by, bz), rows in copy.blocks.items():
        marks = rows.translate(OCCUPIED_MARKS)
        at = marks.find(1)
        while at >= 0:
            xy = (bx * BLOCK + at % 8, by * BLOCK + at // 8 % 8)
            columns.setdefault(xy, {})[bz * BLOCK + at // 64] = rows[at]
            at = marks.find(1, at + 1)
    return columns


def tops_of(column, height):
    """The voxels of a column that have room for a robot of that height above them."""
    tops = []
    heights = sorted(column)
    for z, above in zip(heights, heights[1:] + [None]):
        if above is None or above - z > height:
            tops.append(z)
    return tops


def search(terrain, start, goal):
    """A* over the nodes; the way, or None, and how many nodes were looked at."""
    ahead = [(math.dist(start, goal), 0.0, start)]
    best, came_from, done = {start: 0.0}, {}, set()
    while ahead:
        _, so_far, node = heapq.heappop(ahead)
        if node in done:
            continue
        done.add(node)
        if node == goal:
            way = [node]
            while node in came_from:
                node = came_from[node]
                way.append(node)
            return way[::-1], len(done)
        for other in terrain.next_to(node):
            cost = terrain.cost(other)
            if cost is None or other in done:
                continue
            # Hard ground is worth a detour of some times its length.
            length = so_far + math.dist(node, other) * (1.0 + 10.0 * cost)
            if length < best.get(other, math.inf):
                best[other], came_from[other] = length, node
                heapq.heappush(ahead, (length + math.dist(other, goal), length, other))
    return None, len(done)


def standing(copy, node):
    """Where the base of a robot on that voxel is, in the map frame."""
    x, y, z = copy.centre_of(node)
    return x, y, z + 0.5 * copy.resolution


def count_valid(control, copy, way, options):
    """At how many places of the way the daemon itself would let the robot stand."""
    valid = 0
    for node in way:
        request = pb.Request()
        request.ground.source = pb.MERGE if options.source == "merge" else pb.SELF
        request.ground.t_map_base.extend((*standing(copy, node), 0.0, 0.0, 0.0, 1.0))
        request.ground.length_m = request.ground.width_m = 2.0 * options.radius / math.sqrt(2.0)
        request.ground.unknown_up_to = options.unknown
        request.ground.stair_capable = options.stairs
        valid += control.ask(request).ground.valid
    return valid


def picture_of(terrain, way):
    """Rows of RGB from above, north up: cost from black to white, red without data, the way green."""
    xs, ys = [x for x, _ in terrain.columns], [y for _, y in terrain.columns]
    left, bottom, width, height = min(xs), min(ys), max(xs) - min(xs) + 1, max(ys) - min(ys) + 1
    rows = [bytearray(b"\x30\x38\x50" * width) for _ in range(height)]

    def paint(x, y, colour):
        rows[height - 1 - (y - bottom)][3 * (x - left):3 * (x - left) + 3] = bytes(colour)

    for (x, y), column in terrain.columns.items():
        cost = cost_of(column[min(terrain.tops[(x, y)])])
        paint(x, y, (200, 40, 40) if cost is None else (int(255 * cost),) * 3)
    for x, y, _ in way:
        paint(x, y, (60, 230, 60))
    return rows


def write_png(file, rows, scale=4):
    wide = [b"".join(bytes(row[i:i + 3]) * scale for i in range(0, len(row), 3)) for row in rows for _ in range(scale)]

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", len(wide[0]) // 3, len(wide), 8, 2, 0, 0, 0)
    with open(file, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header))
        out.write(chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in wide))) + chunk(b"IEND", b""))


def plan(control, copy, options):
    """One plan on the map as it is now, told and painted; whether there is a way."""
    terrain = Terrain(copy, Robot(options, copy.resolution))
    begin = options.start or copy.position
    if not begin:
        print("the robot's place is not known: give --start", file=sys.stderr)
        return False
    most = round(options.near / copy.resolution)
    start, goal = (terrain.nearest(copy.key_of(place), most) for place in (begin, options.goal))
    if start is None or goal is None:
        print(f"no ground to stand on within {options.near} m of the {'goal' if start else 'start'}")
        return False
    way, looked_at = search(terrain, start, goal)
    told = f"{len(copy.blocks)} blocks, {sum(map(len, terrain.tops.values()))} ground voxels, {looked_at} looked at"
    if way is None:
        print(f"no way to the goal: {told}")
        return False
    metres = copy.resolution * sum(math.dist(a, b) for a, b in zip(way, way[1:]))
    print(f"way of {metres:.1f} m over {len(way)} voxels: {told}")
    for node in way:
        print("{:.2f} {:.2f} {:.2f}".format(*standing(copy, node)), f"cost {terrain.cost(node):.2f}")
    if options.check:
        print(f"the daemon finds {count_valid(control, copy, way, options)} of {len(way)} places valid")
    if options.picture:
        write_png(options.picture, picture_of(terrain, way))
    return True


def read_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("socket", help="control socket of the daemon")
    add("goal", type=float, nargs=3, metavar=("X", "Y", "Z"), help="map frame, metres")
    add("--start", type=float, nargs=3, help="instead of where the robot is")
    add("--source", choices=("merge", "self"), default="merge")
    add("--near", type=float, default=2.0, help="start and goal may be so far off the ground, m")
    add("--radius", type=float, default=0.3, help="of the footprint, m")
    add("--height", type=float, default=0.6, help="of the robot, m")
    add("--step", type=float, default=0.2, help="that it climbs, m")
    add("--unknown", type=float, default=0.08, help="share of the footprint that may be unknown")
    add("--max-cost", type=float, default=0.20)
    add("--mean-cost", type=float, default=0.10)
    add("--stairs", action="store_true", help="it climbs stairs")
    add("--seconds", type=float, default=0.0, help="go on planning for so long, whenever the map changes")
    add("--rate", type=float, default=1.0, help="at most so often, Hz")
    add("--check", action="store_true", help="ask the daemon whether one may stand along the way")
    add("--picture", help="a PNG of the ground and the way")
    return parser.parse_args()


def main():
    options = read_options()
    until = time.monotonic() + options.seconds
    control = Control(options.socket)
    copy = MapCopy(control, pb.MERGE if options.source == "merge" else pb.SELF)
    found = False
    while True:
        left = max(0.0, until - time.monotonic())
        try:
            if copy.update(wait_s=min(left, 60.0) if copy.answers else 0.0, rate_hz=options.rate):
                found = plan(control, copy, options)
        except Refused as refused:
            if left == 0.0:
                raise SystemExit(f"warrend: {refused}")
            time.sleep(min(left, 1.0 / options.rate))  # no map yet
        if time.monotonic() >= until:
            return 0 if found else 1


if __name__ == "__main__":
    sys.exit(main())
