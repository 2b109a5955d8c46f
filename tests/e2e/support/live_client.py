"""A small WebSocket client (RFC 6455) for strata.v1. Text messages are dicts, and binary messages
are frame headers."""
import base64
import http.client
import json
import os
import socket
import struct
import time
import urllib.parse

from support.strata_server import LONG_S

FRAME_HEADER = struct.Struct("<4sBBHIIQQHHHHHHIII")
LAST_RECTANGLE = 4


class Refused(Exception):
    """The upgrade was refused. `status` is the status of the response."""

    def __init__(self, status, body):
        super().__init__(f"{status} {body[:300]!r}")
        self.status, self.body = status, body


class Closed(Exception):
    """The server closed the connection, with the code if it sent one."""

    def __init__(self, code=None):
        super().__init__(f"closed with {code}")
        self.code = code


# exceptions after the loss of the server or the connection
AWAY = (OSError, http.client.HTTPException, Closed)


class LiveClient:
    def __init__(
        self,
        server,
        model,
        origin=None,
        token=None,
        cookie=None,
        receive_buffer=None,
        subprotocol="strata.v1",
        query="",
        base="",
    ):
        """`base`: the path of a node behind a proxy, before /api."""
        port = server.port
        if port is None:
            raise ConnectionRefusedError("the server is down")
        self.socket = socket.socket()
        if receive_buffer:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
        self.socket.settimeout(LONG_S)
        self.socket.connect((server.host, port))
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        if server.tls:
            self.socket = server.tls.wrap_socket(self.socket, server_hostname=server.host)
        self.buffer, self.bytes_received = b"", 0
        self.moved = ""  # the address in the last message `moved`
        lines = [
            f"GET {base}/api/v1/models/{model}/live{query} HTTP/1.1",
            f"Host: {server.host}:{port}",
            "Upgrade: websocket",
            "Connection: Upgrade",
            "Sec-WebSocket-Version: 13",
            "Sec-WebSocket-Key: " + base64.b64encode(os.urandom(16)).decode(),
            "Sec-WebSocket-Protocol: " + subprotocol,
        ]
        secret = server.token if token is None else token
        if secret:
            lines.append("Authorization: Bearer " + secret)
        if cookie:
            lines.append("Cookie: " + cookie)
        if origin:
            lines.append("Origin: " + origin)
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        head = self._until(b"\r\n\r\n")
        status = int(head.split(b" ")[1])
        if status != 101:
            length = [
                int(line.split(b":")[1])
                for line in head.split(b"\r\n")
                if line.lower().startswith(b"content-length:")
            ]
            body = self._take(length[0]) if length else b""
            self.socket.close()
            raise Refused(status, body)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def _more(self):
        part = self.socket.recv(1 << 16)
        if not part:
            raise Closed()
        self.buffer += part
        self.bytes_received += len(part)

    def _until(self, mark):
        while mark not in self.buffer:
            self._more()
        head, self.buffer = self.buffer.split(mark, 1)
        return head

    def _take(self, size):
        while len(self.buffer) < size:
            self._more()
        taken, self.buffer = self.buffer[:size], self.buffer[size:]
        return taken

    def send_raw(self, opcode, payload):
        self.socket.sendall(self.framed(opcode, payload))

    @staticmethod
    def framed(opcode, payload):
        """Returns the bytes of a message on the wire."""
        size = len(payload)
        head = bytes([0x80 | opcode])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        mask = os.urandom(4)
        whole = (mask * (size // 4 + 1))[:size]
        masked = (int.from_bytes(payload, "big") ^ int.from_bytes(whole, "big")).to_bytes(
            size, "big"
        )
        return head + mask + masked

    def send(self, message):
        self.send_raw(1, (message if isinstance(message, str) else json.dumps(message)).encode())

    def receive(self, end=None):
        """Returns the next message: a dict or, for a frame, {"op": "frame", …its header…}."""
        content = b""
        kind = 0  # the kind of the message whose first part has arrived
        while True:
            if end and time.monotonic() > end:
                raise AssertionError(f"waited {LONG_S} s for a message")
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", self._take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._take(8))[0]
            payload = self._take(size)
            opcode = first & 15
            if opcode == 8:
                raise Closed(struct.unpack(">H", payload[:2])[0] if len(payload) >= 2 else None)
            if opcode == 9:
                self.send_raw(10, payload)
                continue
            if opcode == 10:
                continue
            kind = opcode or kind
            content += payload
            if not first & 0x80:
                continue
            if kind == 1:
                message = json.loads(content)
                self.moved = message.get("url", "") if message["op"] == "moved" else ""
                return message
            header = FRAME_HEADER.unpack(content[: FRAME_HEADER.size])
            return {
                "op": "frame",
                "flags": header[3],
                "view_id": header[4],
                "frame": header[5],
                "camera_seq": header[6],
                "scene_sequence": header[7],
                "x": header[8],
                "y": header[9],
                "width": header[10],
                "height": header[11],
                "full_width": header[12],
                "full_height": header[13],
                "bytes": header[16],
                "payload": content[FRAME_HEADER.size :],
            }

    def receive_until(self, *ops):
        """Returns the next message of these kinds. Acknowledges the frames before it."""
        # the server's pings prevent the socket's own timeout
        end = time.monotonic() + LONG_S
        while True:
            message = self.receive(end)
            if message["op"] == "frame" and message["flags"] & LAST_RECTANGLE:
                self.send({"op": "ack", "view_id": message["view_id"], "frame": message["frame"]})
            if message["op"] in ops:
                return message

    def until_closed(self):
        """Returns when the server has closed the connection."""
        try:
            while True:
                self.receive()
        except Closed:
            pass

    def hello(self, **more):
        self.send({"op": "hello", "client": "e2e", **more})
        return self.receive_until("welcome")


class Connections:
    """Live connections to a model through a proxy, one after the other. After a message `moved`, the
    next one goes to the node that the message names."""

    def __init__(self, gate, model, token=None):
        self.gate, self.model, self.token, self.last = gate, model, token, None

    def connect(self):
        moved, self.last = self.last.moved if self.last else "", None
        base = urllib.parse.urlsplit(moved).path
        self.last = LiveClient(self.gate, self.model, token=self.token, base=base)
        return self.last
