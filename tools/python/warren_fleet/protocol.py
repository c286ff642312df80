# SPDX-License-Identifier: Apache-2.0
"""The local sockets of warrend: frames, and the control socket's questions."""
import pathlib
import socket
import struct
import subprocess
import sys

PROTO = pathlib.Path(__file__).resolve().parents[3] / "proto/warren"
_LENGTH = struct.Struct("<I")


def make_modules(folder):
    """control_pb2 and ingest_pb2, made in `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["protoc", f"-I{PROTO}", f"--python_out={folder}", "control.proto",
                    "ingest.proto"], check=True)
    sys.path.insert(0, str(folder))
    import control_pb2
    import ingest_pb2
    return control_pb2, ingest_pb2


def read_exactly(sock, size):
    """Raises ConnectionError at the end of the stream."""
    buffer = bytearray(size)
    view, have = memoryview(buffer), 0
    while have < size:
        got = sock.recv_into(view[have:])
        if got == 0:
            raise ConnectionError("the other side has closed")
        have += got
    return buffer


def read_frame(sock):
    (length,) = _LENGTH.unpack(read_exactly(sock, _LENGTH.size))
    return bytes(read_exactly(sock, length))


def framed(message):
    body = message if isinstance(message, bytes) else message.SerializeToString()
    return _LENGTH.pack(len(body)) + body


class Refused(Exception):
    """The daemon's own words on why it does not."""


class Control:
    """A connection to a control socket, made anew when the daemon was. Raises OSError when nobody
    answers."""

    def __init__(self, control_pb2, path, timeout_s=10.0):
        self._pb, self._path, self._timeout_s = control_pb2, str(path), timeout_s
        self._sock = None

    def ask(self, **body):
        """E.g. ask(map_save={"path": ..}) gives the response's map_saved."""
        try:
            if self._sock is None:
                self._sock = socket.socket(socket.AF_UNIX)
                self._sock.settimeout(self._timeout_s)
                self._sock.connect(self._path)
            self._sock.sendall(framed(self._request(body)))
            response = self._pb.Response.FromString(read_frame(self._sock))
        except OSError:
            self.close()
            raise
        kind = response.WhichOneof("body")
        if kind == "error":
            raise Refused(response.error.text)
        return getattr(response, kind)

    def _request(self, body):
        request = self._pb.Request()
        for name, fields in body.items():
            part = getattr(request, name)
            part.SetInParent()
            for key, value in fields.items():
                if isinstance(value, list):
                    getattr(part, key).extend(value)
                else:
                    setattr(part, key, value)
        return request

    def close(self):
        if self._sock is not None:
            self._sock.close()
        self._sock = None
