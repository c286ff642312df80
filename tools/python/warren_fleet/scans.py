# SPDX-License-Identifier: Apache-2.0
"""Scans between a simulated lidar and a daemon: kept as they were sent, and sent again."""
import dataclasses
import socket
import struct
import tempfile

from .protocol import framed, read_exactly, read_frame

_LENGTH = struct.Struct("<I")
_FLOAT32_X3 = 12


@dataclasses.dataclass
class Scan:
    """As it went to the daemon. `taken`: when its receipt came that says so (None: none came)."""
    sequence: int
    offset: int
    size: int
    taken: float | None = None


class Recording:
    """The frames of one robot's scans, in a file of `folder` that has no name: it is gone with this
    process, whatever ends that."""

    def __init__(self, folder):
        self._file = tempfile.TemporaryFile(dir=folder)
        self._end = 0

    def add(self, sequence, frame):
        self._file.seek(self._end)
        self._file.write(frame)
        scan = Scan(sequence, self._end, len(frame))
        self._end += len(frame)
        return scan

    def frame(self, scan):
        self._file.seek(scan.offset)
        return self._file.read(scan.size)

    def close(self):
        self._file.close()


def read_request(sock, pb):
    """(message, its bytes with all that belongs to it)"""
    prefix = read_exactly(sock, _LENGTH.size)
    header = read_exactly(sock, _LENGTH.unpack(prefix)[0])
    message = pb.IngestRequest.FromString(bytes(header))
    if message.WhichOneof("body") != "scan":
        return message, bytes(prefix + header)
    scan = message.scan
    if scan.extras:
        raise ValueError("a simulated scan has no extras")
    payload = read_exactly(sock, _FLOAT32_X3 * (scan.points + scan.no_returns))
    return message, bytes(prefix + header + payload)


def connect(path, pb, timeout_s):
    """(socket, how many scans may wait)"""
    sock = socket.socket(socket.AF_UNIX)
    try:
        sock.settimeout(timeout_s)
        sock.connect(str(path))
        hello = pb.IngestRequest(hello=pb.Hello(protocol_version=1, client="warren_fleet"))
        sock.sendall(framed(hello))
        return sock, pb.IngestReply.FromString(read_frame(sock)).welcome.queue_scans
    except BaseException:
        sock.close()
        raise


def replay(path, pb, recording, scans, timeout_s=60.0):
    """Sends them again, in order and none too early. How many were taken."""
    sock, window = connect(path, pb, timeout_s)
    taken = waiting = 0
    with sock:
        for scan in scans:
            sock.sendall(recording.frame(scan))
            waiting += 1
            while waiting >= window:
                taken += _is_taken(sock, pb)
                waiting -= 1
        for _ in range(waiting):
            taken += _is_taken(sock, pb)
    return taken


def _is_taken(sock, pb):
    reply = pb.IngestReply.FromString(read_frame(sock))
    if reply.WhichOneof("body") != "receipt":
        raise RuntimeError(f"no receipt: {reply}")
    return reply.receipt.outcome == pb.ScanReceipt.TAKEN
