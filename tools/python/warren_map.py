# SPDX-License-Identifier: Apache-2.0
"""A copy of a running warrend's map, kept in step over its control socket (docs/PROTOCOL.md, section 5).

Needs protobuf and nothing else. The module `control_pb2` comes from
    protoc -I proto/warren --python_out=. control.proto"""
import socket
import struct

import control_pb2 as pb

BLOCK = 8  # voxels along each edge
UNKNOWN, FREE, OCCUPIED = 0, 1, 2
# Upper edges of the bins of cost; 0 is "no data", which is never safe.
COST_EDGES = (None, 0.05, 0.10, 0.15, 0.20, 0.25, 0.30, 0.35, 0.40, 0.50, 0.60, 0.70, 0.80, 0.90, 0.95, 1.0)


def state_of(code):
    return code & 3


def cost_of(code):
    return COST_EDGES[code >> 2 & 15]


def is_stair(code):
    return code & 64 != 0


class Refused(Exception):
    """What the daemon answered in place of what was asked for."""


class Control:
    """The control socket: one response to each request."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(path)

    def ask(self, request):
        body = request.SerializeToString()
        self._socket.sendall(struct.pack("<I", len(body)) + body)
        (length,) = struct.unpack("<I", self._read(4))
        response = pb.Response.FromString(self._read(length))
        if response.HasField("error"):
            raise Refused(response.error.text)
        return response

    def _read(self, count):
        read = bytearray()
        while len(read) < count:
            part = self._socket.recv(count - len(read))
            if not part:
                raise ConnectionError("warrend has closed the connection")
            read += part
        return bytes(read)


def blocks_of(codes, count):
    """The codes of `count` blocks, 512 bytes each: voxel (x, y, z) of a block is at x + 8 y + 64 z."""
    at = 0
    for _ in range(count):
        rows = bytearray()
        while len(rows) < BLOCK**3:
            code = codes[at]
            at += 1
            if code < 128:  # one voxel
                rows.append(code)
                continue
            more = codes[at]
            at += 1
            rows += bytes((code - 128,)) * (BLOCK**3 - len(rows) if more == 255 else more + 2)
        yield bytes(rows)


class MapCopy:
    """Blocks of the map by key; keys count from `origin`, in the frame of the robot's odometry."""

    def __init__(self, control, source=pb.MERGE, box=None):
        self.blocks = {}  # (x, y, z) -> 512 codes
        self.resolution = 0.0
        self.origin = (0.0, 0.0, 0.0)
        self.fleet_pose = ()  # of the map frame: x y z qx qy qz qw
        self.position = ()  # of the robot's sensor; empty where there is none
        self.answers = self.begun = 0
        self._control = control
        self._request = pb.Request()
        question = self._request.blocks
        question.source = source
        if box is not None:
            question.low_map_m.extend(box[0])
            question.high_map_m.extend(box[1])

    def update(self, wait_s=0.0, rate_hz=1.0):
        """Takes over all that changed; waits for a change if there is none. Whether there was one."""
        question = self._request.blocks
        question.wait_s, question.rate_hz = wait_s, rate_hz
        changed = False
        while True:
            answer = self._control.ask(self._request).blocks
            changed |= self._apply(answer)
            if not answer.more:
                return changed

    def code(self, x, y, z):
        block = self.blocks.get((x >> 3, y >> 3, z >> 3))
        return UNKNOWN if block is None else block[(x & 7) + 8 * (y & 7) + 64 * (z & 7)]

    def key_of(self, place):
        return tuple(int((p - o) // self.resolution) for p, o in zip(place, self.origin))

    def centre_of(self, key):
        return tuple(o + (k + 0.5) * self.resolution for k, o in zip(key, self.origin))

    def _apply(self, answer):
        self.answers += 1
        self.resolution = answer.resolution_m
        self.origin = tuple(answer.origin_map_m)
        self.fleet_pose = tuple(answer.t_fleet_map)
        self.position = tuple(answer.position_map_m)
        if answer.anew:
            self.begun += 1
            self.blocks.clear()
        keys = answer.keys
        count = len(keys) // 3
        for i, rows in enumerate(blocks_of(answer.codes, count)):
            key = (keys[3 * i], keys[3 * i + 1], keys[3 * i + 2])
            if any(rows):
                self.blocks[key] = rows
            else:
                self.blocks.pop(key, None)
        self._request.blocks.cursor = answer.cursor
        return answer.anew or count > 0
