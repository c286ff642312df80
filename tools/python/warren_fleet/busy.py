# SPDX-License-Identifier: Apache-2.0
"""What a planner and an operator ask of a robot all the time."""
import threading
import time

from .protocol import Refused

MERGE = 1  # control.MapSource
_ANSWER_WAIT_S = 1.0
_GROUND_EVERY_S = 1.0
_MESSAGE_EVERY_S = 5.0


class Busy:
    """From now to `stop`: a subscriber of the merge-map, a question about the ground where the robot
    is every second, a message to `addressee` every five."""

    def __init__(self, node, addressee, rate_hz):
        self.answers = self.answer_bytes = self.blocks = 0
        self.grounds = self.grounds_found = self.messages = self.refused = 0
        self._node, self._addressee, self._rate_hz = node, addressee, rate_hz
        self._position = None
        self._stopped = threading.Event()
        self._threads = [threading.Thread(target=run, daemon=True)
                         for run in (self._subscribe, self._ask)]
        for thread in self._threads:
            thread.start()

    def stop(self):
        self._stopped.set()
        for thread in self._threads:
            thread.join(15.0)

    def _subscribe(self):
        control, cursor = self._node.connect(), b""
        while not self._stopped.is_set():
            try:
                answer = control.ask(blocks={"source": MERGE, "cursor": cursor,
                                             "wait_s": _ANSWER_WAIT_S, "rate_hz": self._rate_hz})
            except Refused:  # nothing is mapped yet
                self._stopped.wait(0.2)
                continue
            cursor = answer.cursor
            self.answers += 1
            self.answer_bytes += answer.ByteSize()
            self.blocks += len(answer.keys) // 3
            self._position = list(answer.position_map_m) or self._position
        control.close()

    def _ask(self):
        control, next_message = self._node.connect(), time.monotonic()
        while not self._stopped.wait(_GROUND_EVERY_S):
            if self._position is None:
                continue
            ground = control.ask(ground={"source": MERGE, "t_map_base": [*self._position, 0, 0, 0, 1],
                                         "length_m": 1.0, "width_m": 0.6, "below_m": 2.0})
            self.grounds += 1
            self.grounds_found += ground.columns_with_ground > 0
            if time.monotonic() < next_message:
                continue
            next_message = time.monotonic() + _MESSAGE_EVERY_S
            try:
                control.ask(message_send={"to": self._addressee, "content": b"x" * 200})
                self.messages += 1
            except Refused:
                self.refused += 1
        control.close()
