"""The live connection: messages that are too large, too many, malformed or in another user's name,
and open connections of users who lose the right to them."""
import itertools
import json
import os
import struct
import time
import uuid

from attempts.tools import L, M, close_code, person
from support.cameras import camera_from
from support.live_client import LiveClient
from support.process_memory import PeakGrowth
from support.strata_server import LONG_S

KEPT = "problems, open"


def welcomed(server, **options):
    connection = LiveClient(server, "sheet", **options)
    connection.hello(dpr=1, accept=["jpeg"])
    return connection


def messages(server, section):
    """Sends messages that are refused with a problem. The connection stays open."""

    def refused(what, send, expected, keeps):
        with welcomed(server) as connection:
            send(connection)
            status = connection.receive_until("problem")["status"]
            connection.send({"op": "hello"})
            assert connection.receive_until("problem")["status"] == 409, "it goes on"
            section.tried(what, f"{status}, stays open", f"{expected}, stays open", keeps)

    refused(
        "A message of 300 KB",
        lambda to: to.send({"op": "hello", "client": "x" * 300_000}),
        413,
        "256 KiB for each message",
    )
    refused(
        "Lists nested 100 000 deep in a message",
        lambda to: to.send('{"op":"pick","id":' + "[" * 100_000 + "]" * 100_000 + "}"),
        422,
        "32 levels of objects and lists",
    )
    refused(
        "A binary message",
        lambda to: to.send_raw(2, b"\0" * 1000),
        415,
        "clients may only send text",
    )
    refused(
        "Invalid JSON", lambda to: to.send("{]"), 400, "the protocol's schemas check each message"
    )
    with LiveClient(server, "sheet") as connection:
        connection.send({"op": "undo", "id": str(uuid.uuid4()), "layer": "marks"})
        section.tried(
            "A command before `hello`",
            connection.receive_until("problem")["status"],
            409,
            "a client must send `hello` first",
        )


def frames(server, section):
    """Sends messages for which the server closes the connection. Checks its code (RFC 6455)."""

    def ended(what, send, expected, keeps):
        with welcomed(server) as connection:
            try:
                send(connection)
            except OSError:
                pass  # the server has already closed the connection
            section.tried(what, close_code(connection), expected, keeps)

    def fragments(connection):
        connection.socket.sendall(b"\x01\x80\0\0\0\0")
        for _ in range(100):
            connection.socket.sendall(
                b"\x00\xff" + struct.pack(">Q", 1 << 16) + bytes(4) + b" " * (1 << 16)
            )

    with PeakGrowth(server) as growth:
        ended(
            "A message with a declared size of 4 EiB",
            lambda to: to.socket.sendall(b"\x81\xff" + struct.pack(">Q", 1 << 62) + bytes(4)),
            1009,
            "4 MiB, then the connection ends",
        )
        ended("An endless message in fragments", fragments, 1009, "4 MiB for all fragments")
    section.tried(
        "… memory of the server during both attempts",
        "bounded",
        "bounded",
        "the server allocates nothing for a declared size",
        growth.checked(64),
    )
    ended(
        "Unmasked frames, frames with unknown bits or kinds, and pings of 200 bytes",
        lambda to: to.socket.sendall(b"\x81\x02{}"),
        1002,
        "the server checks the framing",
    )
    for broken in (b"\xf1\x82\0\0\0\0{}", b"\x83\x82\0\0\0\0{}", b"\x89\xfe\x00\xc8" + bytes(204)):
        with welcomed(server) as connection:
            connection.socket.sendall(broken)
            assert close_code(connection) == 1002, broken
    ended(
        "Text that is not UTF-8",
        lambda to: to.send_raw(1, b"\xff\xfe"),
        1007,
        "the server checks the framing",
    )


def floods(server, section):
    """Sends messages as fast as possible."""
    camera = {
        "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, -50, -300, 1],
        "projection": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -20.2, 0],
        "width": 64,
        "height": 64,
    }
    with PeakGrowth(server) as growth, welcomed(server) as connection, welcomed(server) as other:
        sent = 0
        try:
            for sent in range(50_000):
                connection.send({"op": "presence", "pointer": [1, 1]})
        except OSError:
            pass
        code = close_code(connection)
        other.send({"op": "pick", "id": str(uuid.uuid4()), "camera": camera, "x": 1, "y": 1})
        other.receive_until("picked")
    # the code is lost if the server had not read all messages
    assert code in (1008, "cut off"), code
    section.tried(
        "50 000 messages without a pause",
        "ended, other clients are served",
        "ended, other clients are served",
        "500 a second and 1000 at once, then 429; the connection ends with 1008 if refused messages exceed accepted ones by 2000",
        growth.checked(64),
    )
    with PeakGrowth(server) as growth, welcomed(server) as connection:
        for _ in range(20_000):
            connection.socket.sendall(b"\x89\x80\0\0\0\0")
        connection.send({"op": "hello"})
        assert connection.receive_until("problem")["status"] == 409
    section.tried(
        "20 000 pings",
        "answered, stays open",
        "answered, stays open",
        "the server keeps at most one pong",
        growth.checked(64),
    )
    with PeakGrowth(server) as growth:
        crowd = [welcomed(server) for _ in range(200)]
        assert server.get("//livez").status == 200
        for connection in crowd:
            connection.socket.close()
    section.tried(
        "200 live connections of one user",
        "all accepted",
        "all accepted",
        "**no limit for each user**: 2048 connections in total",
        growth.checked(256),
    )
    with welcomed(server, receive_buffer=4096) as lazy, PeakGrowth(server) as growth:
        sent = 0
        try:
            for sent in range(6000):
                lazy.send(
                    {"op": "pick", "id": "x" * 200, "camera": camera, "x": 1, "y": 1, "unknown": 1}
                )
        except OSError:
            pass
        assert server.get("//livez").status == 200
    section.tried(
        "6000 queries of a client that reads no answer",
        "ended or waiting, other clients are served",
        "ended or waiting, other clients are served",
        "4096 answers or 16 MiB wait at most, then the connection ends with 1013; it also ends if a message cannot be sent within 60 s",
        growth.checked(64),
    )


def unread_pictures(server, section):
    """Acknowledges every frame without reading it. Each frame contains noise and is large."""
    slug = server.ok("POST", M + "/layers", {"name": "Noise", "type": "u8"}).json()["slug"]
    raster = server.get(f"{M}/layers/{slug}/texels.npy").body
    head = 10 + struct.unpack("<H", raster[8:10])[0]
    texels = bytearray(len(raster) - head)
    texels[0::2], texels[1::2] = os.urandom(len(texels) // 2), b"\1" * (len(texels) // 2)
    server.ok(
        "PUT",
        f"{M}/layers/{slug}/texels.npy",
        raster[:head] + texels,
        headers={"Content-Type": "application/x-npy"},
    )
    camera = camera_from(server.get(M).json(), [0, 0, 1], 4096, 2160, up=(0, 1, 0))
    with welcomed(server, receive_buffer=4096) as lazy, PeakGrowth(server) as growth:
        end = time.monotonic() + LONG_S
        try:
            for seq in itertools.count(1):
                camera["view"][12] += 1e-3
                lazy.send({"op": "camera", "seq": seq, **camera})
                lazy.send({"op": "ack", "frame": seq})
                assert time.monotonic() < end, "still open"
                time.sleep(0.02)
        except OSError:
            pass
        code = close_code(lazy)
    assert code in (1013, "cut off"), code
    section.tried(
        "Pictures of noise, of 4096 x 2160 pixels, that the client acknowledges but does not read",
        "ended",
        "ended",
        "64 MiB or 256 pictures wait at most, then the connection ends with 1013",
        growth.checked(768),
    )
    server.ok("DELETE", f"{M}/layers/{slug}")


def in_others_names(server, section):
    """Sends commands in the name of another user."""
    mia = server.add_person("mia", "annotator")
    eve = server.add_person("eve", "viewer")
    server.ok("POST", M + "/layers", {"name": "Tomb", "type": "u8", "visibility": "private"})
    edit = {
        "op": "edit",
        "id": str(uuid.uuid4()),
        "layer": "tomb",
        "edit": {"op": "fill", "mode": "where", "where": "x < 7", "value": 1},
    }
    with welcomed(server) as owner, welcomed(server, token=mia) as hand, welcomed(
        server, token=eve
    ) as eyes:

        def answer(connection, message):
            connection.send(message)
            told = connection.receive_until("saved", "problem")
            return 200 if told["op"] == "saved" else told["status"]

        assert answer(owner, edit) == 200
        section.tried(
            "An edit of a private layer, sent again with its id by a user who cannot see the layer",
            answer(hand, edit),
            404,
            "the server looks up the layer before the id",
        )
        section.tried(
            "The same id with an edit of another layer, to learn the result of the first",
            answer(hand, {**edit, "layer": "marks"}),
            422,
            "only the author of an edit gets the answer to a repeat",
        )
        section.tried(
            "An edit that contains another user's name",
            answer(hand, {**edit, "id": str(uuid.uuid4()), "layer": "marks", "user": "owner"}),
            422,
            "the server refuses unknown members; the author is the signed-in user",
        )
        changes = [
            {**edit, "layer": "marks"},
            {"op": "undo", "id": edit["id"], "layer": "marks"},
            {"op": "redo", "id": edit["id"], "layer": "marks"},
            {"op": "record.edit", "id": edit["id"], "table": 1, "key": 1, "editing": True},
            {
                "op": "stroke.begin",
                "id": edit["id"],
                "stroke": edit["id"],
                "layer": "marks",
                "value": 1,
                "camera": server.get(M + "/views/front").json()["camera"],
                "radius_px": 8,
            },
        ]
        section.tried(
            "Edits, undo, redo, a stroke and a record's lock, as a viewer",
            {answer(eyes, {**message, "id": str(uuid.uuid4())}) for message in changes},
            403,
            "the server checks the role for each message",
        )
        stroke = str(uuid.uuid4())
        owner.send({**changes[-1], "id": str(uuid.uuid4()), "stroke": stroke})
        section.tried(
            "Continuing a stroke of another user",
            answer(
                hand,
                {
                    "op": "stroke.extend",
                    "id": str(uuid.uuid4()),
                    "stroke": stroke,
                    "n": 0,
                    "path": [[1, 1]],
                },
            ),
            404,
            "only its author can continue a stroke",
        )


def outlived(server, section):
    """Tests open connections of users who lose the right to them."""

    def demoted(user):
        server.ok("PATCH", f"/users/{user}", {"role": "viewer"})

    ends = [
        ("sign-out", lambda browser, user: browser.ok("POST", "/logout")),
        ("the revocation of a token", None),
        (
            "a new password",
            lambda browser, user: browser.ok(
                "POST",
                "/me/password",
                {"current": "seven blue herons at noon", "password": "twelve otters and a heron"},
            ),
        ),
        ("another role", lambda browser, user: demoted(user)),
        (
            "disabling",
            lambda browser, user: server.ok("PATCH", f"/users/{user}", {"disabled": True}),
        ),
        ("deletion", lambda browser, user: server.ok("DELETE", f"/users/{user}")),
    ]
    codes, longest = set(), 0.0
    for number, (_, end) in zip(itertools.count(1), ends):
        user = f"open{number}"
        browser = person(server, user)
        if end is None:
            made = browser.ok("POST", "/me/tokens", {"name": "t"}).json()
            connection = welcomed(server, token=made["secret"])
            start = time.monotonic()
            browser.ok("DELETE", f"/me/tokens/{made['token']['id']}")
        else:
            connection = welcomed(server, token="", cookie=browser.cookie, origin=server.url)
            start = time.monotonic()
            end(browser, user)
        codes.add(close_code(connection))
        longest = max(longest, time.monotonic() - start)
    section.tried(
        "Open connections at " + ", ".join(what for what, _ in ends),
        codes,
        1008,
        "the call that ends the right closes the sockets",
        f"{max(1, round(longest))} s at most",
    )


def attempts(server, table):
    section = table.section("Live connections")
    camera = {
        "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, -50, -300, 1],
        "projection": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1.02, -1, 0, 0, -20.2, 0],
        "width": 640,
        "height": 480,
    }
    server.ok("POST", M + "/views", {"name": "Front", "camera": camera})
    for attempt in (messages, frames, floods, unread_pictures, in_others_names, outlived):
        attempt(server, section)
    assert json.loads(server.get(L).body)["slug"] == "marks"
