"""The live connection: participants, invalid clients, slow clients, and an orderly stop of
the server."""
import glob
import json
import os
import signal
import threading
import uuid
from contextlib import ExitStack

import pytest
from support.cameras import camera_from
from support.live_client import LAST_RECTANGLE, Closed, LiveClient, Refused
from support.meshes import folded_grid
from support.process_memory import resident_mb
from support.strata_server import wait_for

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
M, L = "/models/grid", "/models/grid/layers/marks"
VIEWERS = 16


def new_id():
    return str(uuid.uuid4())


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(), "grid.ply", unit="mm", name="Grid")
    for name in ("Marks", "Other"):
        server.ok("POST", M + "/layers", {"name": name, "type": "u8"})
    return server


def wait_for_picture(live, seq):
    while True:
        frame = live.receive_until("frame")
        if frame["flags"] & LAST_RECTANGLE and frame["camera_seq"] >= seq:
            return


def test_leaving(server):
    """After many viewers have left, the server returns their memory to the system."""
    model = server.get(M).json()
    with ExitStack() as people:

        def come(number):
            live = people.enter_context(LiveClient(server, "grid"))
            live.hello()
            live.send(
                {
                    "op": "camera",
                    "seq": 1,
                    "moving": False,
                    **camera_from(model, (0.3, number / VIEWERS, 1), 1280, 720),
                }
            )
            wait_for_picture(live, 1)

        come(0)
        alone = resident_mb(server)
        for number in range(1, VIEWERS):
            come(number)
        most = resident_mb(server)
        assert (
            most > alone + 8 * VIEWERS
        ), f"{VIEWERS} views at rest take only {most - alone:.0f} MB: this test shows nothing"
    wait_for(
        lambda: resident_mb(server) < alone + (most - alone) / 2, "the memory of those who left"
    )


def test_upgrade(server):
    for what, model, more, status in (
        ("no token", "grid", {"token": ""}, 401),
        ("unknown token", "grid", {"token": "x" * 48}, 401),
        ("unknown model", "nothing", {}, 404),
        ("foreign origin", "grid", {"origin": "https://elsewhere.example"}, 403),
        ("another subprotocol", "grid", {"subprotocol": "strata.v9"}, 400),
        ("null origin", "grid", {"origin": "null"}, 403),
        ("like our origin", "grid", {"origin": server.url + ".example"}, 403),
    ):
        try:
            LiveClient(server, model, **more)
        except Refused as refused:
            assert refused.status == status, (what, refused)
            assert json.loads(refused.body)["status"] == status, (what, refused)
        else:
            raise AssertionError(f"{what}: the upgrade was not refused")
    with LiveClient(server, "grid", origin=server.url) as live:
        assert live.hello()["model"]["slug"] == "grid"


def test_sign_out(server):
    """Signing out ends the session everywhere. Its connections end, and connections of other
    sessions stay open."""

    def sign_in():
        login = server.post(
            "/login", {"token": server.token}, token=False, headers={"Origin": server.url}
        )
        return login.headers["Set-Cookie"].split(";")[0]

    mine, other = sign_in(), sign_in()
    with LiveClient(server, "grid", token="", cookie=mine, origin=server.url) as one, LiveClient(
        server, "grid", token="", cookie=mine, origin=server.url
    ) as two, LiveClient(server, "grid", token="", cookie=other, origin=server.url) as third:
        for live in (one, two, third):
            live.hello()
        server.ok("POST", "/logout", token=False, headers={"Cookie": mine, "Origin": server.url})
        for live in (one, two):
            try:
                while True:
                    live.receive()
            except Closed as closed:
                assert closed.code == 1008, closed.code
        third.send(
            {
                "op": "pick",
                "id": "still here",
                "camera": camera_from(server.get(M).json(), [0, 0, 1], up=(0, 1, 0)),
                "x": 320,
                "y": 240,
            }
        )
        assert third.receive_until("picked")["hit"]
    try:
        LiveClient(server, "grid", token="", cookie=mine, origin=server.url)
    except Refused as refused:
        assert refused.status == 401, refused
    else:
        raise AssertionError("a session that ended came in again")


def test_bad_messages(server):
    """Every invalid message of the protocol fixtures gets a problem with the name of the field, and
    the connection stays open."""
    fixtures = sorted(glob.glob(os.path.join(ROOT, "protocol", "fixtures", "invalid", "*.json")))
    with LiveClient(server, "grid") as live:
        live.send({"op": "camera", "seq": 1})
        assert live.receive_until("problem")["status"] == 422
        live.send({"op": "ack", "frame": 1})
        assert live.receive_until("problem")["title"] == "Missing hello message"
        live.hello()
        tried = 0
        for file in fixtures:
            with open(file, encoding="utf-8") as opened:
                fixture = json.load(opened)
            if os.path.basename(file).startswith("http_"):
                continue
            live.send(fixture["text"] if "text" in fixture else json.dumps(fixture["json"]))
            problem = live.receive_until("problem")
            assert problem["status"] == fixture["status"], (file, problem)
            assert problem.get("field", "") == fixture["field"], (file, problem)
            tried += 1
        assert tried > 40, tried

        for what, raw, status in (
            ("binary", (2, b"\0\1\2"), 415),
            ("too large", (1, b" " * (300 * 1024)), 413),
            (
                "too large and whole",
                (1, json.dumps({"op": "hello", "client": "x" * 300000}).encode()),
                413,
            ),
        ):
            live.send_raw(*raw)
            problem = live.receive_until("problem")
            assert problem["status"] == status, (what, problem)
        camera = camera_from(server.get(M).json(), [0, 0, 1], up=(0, 1, 0))
        stroke = {
            "op": "stroke.begin",
            "id": new_id(),
            "stroke": new_id(),
            "layer": "marks",
            "camera": camera,
            "radius_px": 5,
            "value": 3,
        }
        for what, message, status in (
            ("hello twice", {"op": "hello"}, 409),
            (
                "a stroke that was not begun",
                {
                    "op": "stroke.extend",
                    "id": new_id(),
                    "stroke": new_id(),
                    "n": 0,
                    "path": [[1, 1]],
                },
                404,
            ),
            ("the end of none", {"op": "stroke.end", "id": new_id(), "stroke": new_id()}, 404),
            ("an unknown layer", {**stroke, "layer": "nothing"}, 404),
            ("a layer that is a number", {**stroke, "layer": 999999}, 404),
            ("a value too large", {**stroke, "value": 256}, 422),
            ("an undo of nothing", {"op": "undo", "id": new_id(), "layer": "marks"}, 409),
            ("a view too many", {"op": "camera", "view_id": 15, "seq": 1, **camera}, 422),
            (
                "settings of an unknown layer",
                {"op": "layers", "layers": [{"layer": "nothing"}]},
                404,
            ),
        ):
            live.send(message)
            problem = live.receive_until("problem")
            assert problem["status"] == status and problem.get("ref") == message.get("id"), (
                what,
                problem,
            )
        # the connection still works
        live.send({"op": "pick", "id": "p", "camera": camera, "x": 320, "y": 240})
        assert live.receive_until("picked")["hit"]
    with LiveClient(server, "grid") as live:
        live.hello()
        try:
            live.send_raw(1, b" " * (5 << 20))
            while True:
                live.receive()
        except (Closed, OSError):
            pass
    assert server.get(L).json()["sequence"] == 0, "a refused message painted"


def test_presence(server):
    """Presence contains names, colors, pointers with the current brush, the followed participant,
    and only that participant's camera."""
    with LiveClient(server, "grid") as one, LiveClient(server, "grid") as two, LiveClient(
        server, "grid"
    ) as three:
        sessions = [live.hello()["session"] for live in (one, two, three)]
        model = server.get(M).json()
        camera = camera_from(model, [0, 0, 1], up=(0, 1, 0))
        plane = [0.0, 0.0, 1.0, 1000.0]
        gone = {}

        def heard(live, condition):
            """Returns the first presence message that fulfills the condition. Earlier messages may
            lack participants."""
            while True:
                users = {user["session"]: user for user in live.receive_until("presence")["users"]}
                if set(sessions) - {gone.get("session")} <= set(users) and condition(users):
                    return users

        def refused(live, follow, status):
            live.send({"op": "presence", "follow": follow, "leading": True})
            problem = live.receive_until("problem")
            assert (problem["status"], problem["field"]) == (status, "follow"), problem

        users = heard(one, lambda users: set(users) == set(sessions))
        assert {user["name"] for user in users.values()} == {"owner"} and len(
            {user["color"] for user in users.values()}
        ) == 1, users

        two.send({"op": "camera", "seq": 1, **camera, "section": [plane]})
        two.send({"op": "presence", "pointer": [320, 240], "radius": 0.25, "leading": True})
        users = heard(
            one, lambda users: "pointer" in users[sessions[1]] and users[sessions[1]]["leading"]
        )
        assert users[sessions[1]]["pointer"]["radius"] == 0.25, users
        assert not any("camera" in user or "following" in user for user in users.values()), users

        refused(one, new_id(), 404)
        refused(one, sessions[0], 409)
        one.send({"op": "presence", "follow": sessions[1]})
        users = heard(one, lambda users: "camera" in users[sessions[1]])
        assert users[sessions[1]]["camera"] == {
            name: camera[name] for name in ("view", "projection", "width", "height")
        }, users
        assert [user["session"] for user in users.values() if "camera" in user] == [
            sessions[1]
        ], users
        assert not users[sessions[0]]["leading"], "what is refused changes nothing"
        nearer = camera_from(model, [0.2, 0, 1], up=(0, 1, 0))
        two.send({"op": "camera", "view_id": 1, "seq": 1, **camera})
        two.send({"op": "camera", "seq": 2, **nearer})
        heard(one, lambda users: users[sessions[1]]["camera"]["view"] == nearer["view"])

        three.send({"op": "presence", "follow": sessions[0]})
        users = heard(two, lambda users: "following" in users[sessions[2]])
        assert (
            users[sessions[0]]["following"] == sessions[1]
            and users[sessions[2]]["following"] == sessions[0]
        ), users
        assert not any(
            "camera" in user for user in users.values()
        ), "who follows nobody gets no camera"
        refused(two, sessions[2], 409)
        two.socket.close()
        gone["session"] = sessions[1]
        users = heard(one, lambda users: sessions[1] not in users)
        assert (
            "following" not in users[sessions[0]] and users[sessions[2]]["following"] == sessions[0]
        ), users


def test_colors(server):
    """Users at one model have different colors while there are enough colors. A user in two
    browsers has one color."""
    tokens = [server.add_person(f"guest{i}", "viewer") for i in range(5)]
    lives = [LiveClient(server, "grid", token=token) for token in [*tokens, tokens[0]]]
    try:
        sessions = [live.hello()["session"] for live in lives]
        while True:
            users = {user["session"]: user for user in lives[0].receive_until("presence")["users"]}
            if set(sessions) <= set(users):
                break
        colors = [users[session]["color"] for session in sessions]
        assert len(set(colors[:5])) == 5 and colors[5] == colors[0], users
    finally:
        for live in lives:
            live.socket.close()


def test_slow_client(server):
    """Two clients that never read do not delay a third client, which still receives frames and
    saved edits."""
    model = server.get(M).json()
    cameras = [
        camera_from(model, [0.05 * turn, 0.2, 1], width=1280, height=720, up=(0, 1, 0))
        for turn in range(12)
    ]
    slow = [LiveClient(server, "grid", receive_buffer=4096) for _ in range(2)]
    for live in slow:
        live.send({"op": "hello"})
        for view in range(4):
            live.send({"op": "camera", "view_id": view, "seq": 1, **cameras[0]})
    with LiveClient(server, "grid") as live:
        live.hello()
        for turn, camera in enumerate(cameras):
            for index, lazy in enumerate(slow):
                lazy.send({"op": "camera", "seq": turn + 2, "moving": True, **camera})
                lazy.send({"op": "pick", "id": f"{index}", "x": 640, "y": 360})
            live.send({"op": "camera", "seq": turn + 1, "moving": True, **camera})
            wait_for_picture(live, turn + 1)
            for value in range(5):
                identity = new_id()
                live.send(
                    {
                        "op": "edit",
                        "id": identity,
                        "layer": "marks",
                        "edit": {
                            "op": "stroke",
                            "value": value + 1,
                            "camera": camera,
                            "radius_px": 30,
                            "path": [[400 + 40 * turn, 300], [640, 360]],
                        },
                    }
                )
                assert live.receive_until("saved", "unsaved", "problem")["op"] == "saved"
    for live in slow:
        live.socket.close()
    assert server.get("//livez").status == 200


def test_what_was_answered_before_the_end_is_kept(server, story):
    """After SIGTERM under load, acknowledged edits are kept and refused edits do not exist. The
    exit status is 0."""
    answered, refused = [], []
    go_on = threading.Event()

    def paint(seed):
        for number in range(10000):
            key = f"{seed} {number}"
            edit = {
                "op": "fill",
                "mode": "where",
                "where": "true",
                "value": (seed * 40 + number) % 250 + 1,
            }
            try:
                answer = server.post(
                    M + "/layers/other/edits", edit, headers={"Idempotency-Key": key}
                )
            except OSError:
                return
            except Exception as broken:  # pylint: disable=broad-except
                refused.append(broken)
                return
            if answer.status != 200:
                refused.append(answer)
                return
            answered.append(answer.json()["sequence"])
            if len(answered) > 20:
                go_on.set()

    painters = [threading.Thread(target=paint, args=(seed,)) for seed in range(4)]
    for painter in painters:
        painter.start()
    assert go_on.wait(120)
    with LiveClient(server, "grid") as live:
        live.hello()
        server.process.send_signal(signal.SIGTERM)
        try:
            while True:
                live.receive()
        except Closed as closed:
            # 1001 means "going away"; None if no code arrived
            assert closed.code in (1001, None), closed.code
        except OSError:
            pass
    assert server.process.wait(120) == 0
    for painter in painters:
        painter.join(120)
        assert not painter.is_alive()
    wait_for(lambda: server.postmaster() is None, "PostgreSQL to end with the server")
    assert all(getattr(answer, "status", 503) in (429, 503) for answer in refused), refused
    server.start()
    kept = {
        row["sequence"] for row in server.get(M + "/layers/other/edits?limit=1000").json()["edits"]
    }
    assert set(answered) <= kept, sorted(set(answered) - kept)
    story.answered = len(answered)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
