# SPDX-License-Identifier: Apache-2.0
"""A robot's lidar driver: takes the simulator's scans, hands them to the daemon, comes back when that
was killed, and remembers what was acknowledged."""
import socket
import threading
import time

from .protocol import Refused, framed, read_frame
from .scans import connect, read_request

_RETRY_S = 0.1


class Relay:
    """Between `self.socket`, where one simulator connects, and a node's ingest socket. `sent` are the
    scans that the daemon has, or had before it lost them: those of `lost` (life, scan, when it was
    killed or None)."""

    def __init__(self, ingest_pb2, node, recording):
        self._pb, self.node, self._recording = ingest_pb2, node, recording
        self.socket = node.work / f"{node.name}.driver"
        self.sent, self.lost, self.dropped = [], [], 0
        self.faults = []
        self.killed_at = None  # set by who kills the daemon
        self._lock = threading.Lock()
        self._answering = threading.Lock()
        self._waiting = {}     # by sequence, without a receipt
        self._daemon = self._simulator = None
        self._window = 0
        self._stopped = threading.Event()
        self._listener = socket.socket(socket.AF_UNIX)
        self.socket.unlink(missing_ok=True)
        self._listener.bind(str(self.socket))
        self._listener.listen(1)
        self._threads = [threading.Thread(target=run, daemon=True)
                         for run in (self._take_scans, self._keep_connected)]
        for thread in self._threads:
            thread.start()

    def close(self):
        self._stopped.set()
        for sock in (self._listener, self._simulator, self._daemon):
            if sock is not None:
                try:
                    sock.shutdown(socket.SHUT_RDWR)
                except OSError:
                    pass
                sock.close()
        for thread in self._threads:
            thread.join(5.0)

    def is_settled(self):
        """No scan is without a receipt."""
        with self._lock:
            return not self._waiting and self._daemon is not None

    # Simulator to daemon.

    def _take_scans(self):
        try:
            self._simulator, _ = self._listener.accept()
            while not self._stopped.is_set():
                message, frame = read_request(self._simulator, self._pb)
                if message.WhichOneof("body") == "hello":
                    self._welcome(message.hello)
                else:
                    self._forward(message.scan.sequence, frame)
        except (OSError, ValueError) as error:
            if not self._stopped.is_set() and not isinstance(error, ConnectionError):
                self.faults.append(f"{self.node.name}: from the simulator: {error}")

    def _welcome(self, hello):
        self._answer(self._pb.IngestReply(welcome=self._pb.Welcome(
            protocol_version=hello.protocol_version, queue_scans=8, max_payload_bytes=1 << 28,
            sensors=["lidar"])))

    # A scan that finds no daemon, or one that is busy, is let go, as by any driver.
    def _forward(self, sequence, frame):
        with self._lock:
            if self._daemon is not None and len(self._waiting) < self._window:
                scan = self._recording.add(sequence, frame)
                try:
                    self._daemon.sendall(frame)
                except OSError:
                    self._drop_daemon()
                else:
                    self.sent.append(scan)
                    self._waiting[sequence] = scan
                    return
            self.dropped += 1
        self._say_dropped(sequence)

    def _answer(self, reply):
        try:
            with self._answering:
                self._simulator.sendall(framed(reply))
        except OSError:
            pass  # it has ended

    def _say_dropped(self, sequence):
        receipt = self._pb.ScanReceipt(sequence=sequence,
                                       outcome=self._pb.ScanReceipt.DROPPED_OVERLOAD)
        self._answer(self._pb.IngestReply(receipt=receipt))

    # Daemon to simulator.

    def _keep_connected(self):
        while not self._stopped.is_set():
            try:
                survived = self._node_scans()
                sock, window = connect(self.node.ingest, self._pb, 10.0)
            except (OSError, ValueError, Refused):
                time.sleep(_RETRY_S)
                continue
            sock.settimeout(None)
            with self._lock:
                self._cut(survived)
                self._daemon, self._window = sock, window
            self._read_receipts(sock)

    def _node_scans(self):
        control = self.node.connect()
        try:
            return control.ask(status={}).map.scans
        finally:
            control.close()

    def _cut(self, survived):
        """What the daemon has of what was sent: the first ones. The rest it lost with its life."""
        if survived > len(self.sent):
            self.faults.append(f"{self.node.name} has {survived} scans of {len(self.sent)} sent")
        for scan in self.sent[survived:]:
            self.lost.append((self.node.life, scan, self.killed_at))
        del self.sent[survived:]

    def _read_receipts(self, sock):
        try:
            while True:
                reply = self._pb.IngestReply.FromString(read_frame(sock))
                if reply.WhichOneof("body") != "receipt":
                    self.faults.append(f"{self.node.name} says: {reply}")
                    break
                self._note(reply.receipt)
                self._answer(reply)
        except OSError:
            pass
        with self._lock:
            if self._daemon is sock:
                self._drop_daemon()

    def _note(self, receipt):
        with self._lock:
            scan = self._waiting.pop(receipt.sequence, None)
            if scan is None:
                self.faults.append(f"{self.node.name}: a receipt for scan {receipt.sequence}, "
                                   "which waits for none")
            elif receipt.outcome == self._pb.ScanReceipt.TAKEN:
                scan.taken = time.time()
            else:
                self.sent.remove(scan)
                self.dropped += 1

    def _drop_daemon(self):
        self._daemon.close()
        self._daemon = None
        for sequence in self._waiting:
            self._say_dropped(sequence)
        self._waiting.clear()
