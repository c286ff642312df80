#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Sends one scan to a running warrend. The module `ingest_pb2` comes from
    protoc -I proto/warren --python_out=. ingest.proto
Usage: warren_ingest.py SOCKET SENSOR"""
import socket
import struct
import sys
import time

import ingest_pb2 as pb


def send(sock, message, payload=b""):
    header = message.SerializeToString()
    sock.sendall(struct.pack("<I", len(header)) + header + payload)


def receive(sock):
    (length,) = struct.unpack("<I", sock.recv(4, socket.MSG_WAITALL))
    return pb.IngestReply.FromString(sock.recv(length, socket.MSG_WAITALL))


sock = socket.socket(socket.AF_UNIX)
sock.connect(sys.argv[1])
send(sock, pb.IngestRequest(hello=pb.Hello(protocol_version=1, client="python")))
print("welcome:", receive(sock).welcome)
points = [(2.0, -1.0 + 0.02 * i, 0.0) for i in range(100)]  # a wall, seen from the origin
now_ns = time.time_ns()  # odometry starts now: a frame epoch never used before
scan = pb.ScanHeader(sequence=1, sensor=sys.argv[2], frame_epoch=now_ns, stamp_ns=now_ns, points=len(points))
scan.t_map_base.qw = 1.0
send(sock, pb.IngestRequest(scan=scan), b"".join(struct.pack("<3f", *p) for p in points))
receipt = receive(sock).receipt
print("receipt:", receipt)
sys.exit(0 if receipt.outcome == pb.ScanReceipt.TAKEN else 1)
