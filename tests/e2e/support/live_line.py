"""A live connection that is read and written at the same time, and that can be cut off in several
ways."""
import json
import random
import socket
import struct
import threading
import time

from support.live_client import AWAY, LAST_RECTANGLE, LiveClient
from support.strata_server import LONG_S

WAYS = ("close", "reset", "half a message", "hang")


class Line:
    """A connection that a separate thread reads. It acknowledges frames as a page does."""

    def __init__(self, live, hears, fault, number=0):
        self.live, self.hears, self.fault, self.number = live, hears, fault, number
        self.random = random.Random(number)
        self.sending = threading.Lock()
        self.frames, self.shown = [], -1  # (time, newest sequence) of whole frames
        self.opened, self.ended, self.given_up = time.monotonic(), None, False
        self.code = None
        self.reader = threading.Thread(target=self._read, daemon=True)

    def send(self, message):
        with self.sending:
            self.live.send(message)

    def send_half(self, message):
        whole = LiveClient.framed(1, json.dumps(message).encode())
        with self.sending:
            self.live.socket.sendall(whole[: self.random.randint(1, len(whole) - 1)])

    def _read(self):
        try:
            while not self.given_up:
                message = self.live.receive()
                if message["op"] == "frame":
                    self._frame(message)
                else:
                    self.hears(self, message)
        except AWAY as error:
            self.code = getattr(error, "code", None) or repr(error)
        except Exception as error:  # pylint: disable=broad-except
            self.fault(f"while reading: {error!r}")
        self.ended = time.monotonic()

    def _frame(self, frame):
        if not frame["flags"] & LAST_RECTANGLE:
            return
        now, sequence = time.monotonic(), frame["scene_sequence"]
        assert (
            sequence >= self.shown
        ), f"a frame shows {sequence}, after one that showed {self.shown}"
        self.shown = sequence
        self.frames.append((now, sequence))
        self.send({"op": "ack", "view_id": frame["view_id"], "frame": frame["frame"]})

    def give_up(self, way):
        """Ends the connection so that the server receives an end, a reset, or (hang) nothing."""
        self.given_up = True
        try:
            self.live.socket.shutdown(socket.SHUT_RDWR if way == "close" else socket.SHUT_RD)
        except OSError:
            pass  # the server has already closed the connection
        self.reader.join(LONG_S)
        if way in ("reset", "half a message"):
            self.live.socket.setsockopt(
                socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0)
            )
        if way != "hang":
            self.live.socket.close()
