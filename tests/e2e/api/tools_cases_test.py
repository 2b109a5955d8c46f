"""Brush shapes of the site: made from pictures, used for painting over HTTP and WebSocket, renamed,
deleted while they are in use, and tested again after a restart."""
import uuid

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import bumpy_ball
from support.pictures import pixels, png

M, L = "/models/ball", "/models/ball/layers/marks"
PNG = {"Content-Type": "image/png"}
SIDE = 256
ALPHA = slice(3, 4)


def left_half(size):
    return png(size, size, lambda x, y: (255,) * 3 if x < size // 2 else (0,) * 3)


def new_id():
    return str(uuid.uuid4())


@pytest.fixture(scope="module", autouse=True)
def camera(server):
    model = server.import_model(bumpy_ball(), "ball.ply", unit="mm", name="Ball")
    server.ok("POST", M + "/layers", {"name": "Marks", "type": "u8", "resolution": 2048})
    return camera_from(model, (0, -1, 0))


def test_making(server, story):
    assert server.get("/tools").json() == {"tools": [], "total": 0}
    key = {**PNG, "Idempotency-Key": "left"}
    made = server.ok("POST", "/tools?name=Left+half", left_half(64), headers=key)
    tool = made.json()
    assert made.status == 201 and made.headers["Location"] == "/api/v1/tools/left-half", made
    assert tool == {
        "id": tool["id"],
        "name": "Left half",
        "slug": "left-half",
        "deleted": False,
    }, tool
    again = server.ok("POST", "/tools?name=Left+half", left_half(64), headers=key)
    assert again.json() == tool and server.get("/tools").json() == {"tools": [tool], "total": 1}
    rows = pixels(server.ok("GET", "/tools/left-half/picture").body, ALPHA)
    assert len(rows) == SIDE and all(row == [(255,)] * 128 + [(0,)] * 128 for row in rows)

    # a wide picture with transparency, and a dark picture on a light background
    wide = png(40, 20, lambda x, y: (9, 9, 9, 255 if x >= 20 else 0))
    right = server.ok("POST", "/tools?name=Wide", wide, headers=PNG).json()
    rows = pixels(server.ok("GET", f"/tools/{right['id']}/picture").body, ALPHA)
    assert rows[128] == [(0,)] * 128 + [(255,)] * 128 and not any(a for (a,) in rows[40])
    dark = server.ok("POST", "/tools?name=Dark&part=dark", left_half(16), headers=PNG).json()
    assert (
        pixels(server.ok("GET", "/tools/dark/picture").body, ALPHA)[0]
        == [(0,)] * 128 + [(255,)] * 128
    )

    picture, big = left_half(32), png(2049, 4, lambda x, y: (255, 255, 255))
    for what, method, path, body, headers, status, field in [
        ("no picture", "POST", "/tools?name=x", b"hello", PNG, 415, None),
        ("a picture that ends early", "POST", "/tools?name=x", picture[:50], PNG, 422, None),
        ("nothing", "POST", "/tools?name=x", b"", PNG, 400, "body"),
        ("a picture too large", "POST", "/tools?name=x", big, PNG, 422, None),
        (
            "an empty shape",
            "POST",
            "/tools?name=x",
            png(8, 8, lambda x, y: (10, 10, 10)),
            PNG,
            422,
            "body",
        ),
        ("no name", "POST", "/tools", picture, PNG, 422, "name"),
        ("a name too long", "POST", "/tools?name=" + "x" * 201, picture, PNG, 422, "name"),
        ("unknown part", "POST", "/tools?name=x&part=upper", picture, PNG, 422, "part"),
        ("unknown parameter", "POST", "/tools?name=x&size=3", picture, PNG, 400, None),
        ("unknown tool", "GET", "/tools/none", None, {}, 404, None),
        ("unknown tool's picture", "GET", "/tools/none/picture", None, {}, 404, None),
        ("an empty change", "PATCH", "/tools/wide", {}, {}, 422, None),
        (
            "a change of shape",
            "PATCH",
            "/tools/wide",
            {"name": "x", "part": "dark"},
            {},
            422,
            "part",
        ),
        ("an empty name", "PATCH", "/tools/wide", {"name": ""}, {}, 422, "name"),
        ("a stale change", "PATCH", "/tools/wide", {"name": "x"}, {"If-Match": '"v9"'}, 412, None),
        ("a change of nothing", "PATCH", "/tools/none", {"name": "x"}, {}, 404, None),
        ("deletion of nothing", "DELETE", "/tools/none", None, {}, 404, None),
    ]:
        answer = server.request(method, path, body, headers=headers)
        assert answer.status == status, f"{what}: {answer}"
        assert field is None or answer.json()["field"] == field, f"{what}: {answer}"
    assert server.request("POST", "/tools?name=x", picture, headers=PNG, token=False).status == 401
    assert server.get("/tools").json()["total"] == 3
    story.tool, story.dark = tool, dark


def test_strokes(server, camera, story):
    tool = story.tool
    dark = story.dark
    stroke = {"op": "stroke", "value": 1, "camera": camera, "radius_px": 60, "path": [[320, 240]]}
    paint = lambda **more: server.ok("POST", L + "/edits", {**stroke, **more}).json()[
        "texels_changed"
    ]
    square = paint(shape="square")
    server.ok("POST", L + "/undo")
    left = paint(shape="left-half")
    right = paint(shape=dark["id"], value=2)
    assert abs(left + right - square) < 0.01 * square and abs(left - right) < 0.2 * square, (
        left,
        right,
        square,
    )
    values = [
        server.ok("POST", M + "/pick", {"camera": camera, "x": x, "y": 240}).json()["values"][
            "marks"
        ]["value"]
        for x in (290, 350)
    ]
    assert values == [1, 2], values
    history = server.get(L + "/edits").json()["edits"]
    assert [edit["shape"] for edit in history[:2]] == [dark["id"], tool["id"]], history[:2]
    # the sweep covers the area under the left half at the start, at the end, and between them
    swept = paint(shape="left-half", value=3, path=[[200, 240], [440, 240]])
    assert swept > 2 * left, (swept, left)
    # with a small angle, the rim of the ball gets no paint
    everything = paint(shape="square", radius_px=400, value=4)
    facing = paint(shape="square", radius_px=400, value=5, max_angle_deg=45)
    assert 0.2 * everything < facing < 0.8 * everything, (facing, everything)
    for what, more, field in (
        ("an unknown tool", {"shape": "star"}, "shape"),
        ("an unknown id", {"shape": 999}, "shape"),
        ("no shape", {"shape": 0}, "shape"),
        ("a list", {"shape": ["disc"]}, "shape"),
    ):
        answer = server.post(L + "/edits", {**stroke, **more})
        assert answer.status == 422 and answer.json()["field"] == field, f"{what}: {answer}"


def test_deletion_in_use(server, camera, story):
    """A user paints with a brush shape while another user deletes the shape. The stroke continues,
    all participants are notified, and the texels remain."""
    tool = story.tool
    with LiveClient(server, "ball") as painter, LiveClient(server, "ball") as other:
        painter.hello()
        other.hello()
        stroke = new_id()
        begin = {
            "op": "stroke.begin",
            "id": new_id(),
            "stroke": stroke,
            "layer": "marks",
            "value": 7,
            "camera": camera,
            "radius_px": 30,
            "shape": tool["id"],
        }
        first = {
            "op": "stroke.extend",
            "id": new_id(),
            "stroke": stroke,
            "n": 0,
            "path": [[300, 200], [320, 240]],
        }
        painter.send(begin)
        painter.send(first)
        assert painter.receive_until("saved")["n"] == 0
        renamed = server.ok("PATCH", "/tools/left-half", {"name": "Port side"}).json()
        assert renamed["slug"] == "left-half"
        assert server.request("DELETE", "/tools/left-half").status == 204
        for live in (painter, other):
            event = live.receive_until("tool")
            assert event == {
                "op": "tool",
                "event": "changed",
                "tool_id": tool["id"],
                "tool": renamed,
            }, event
            assert live.receive_until("tool") == {
                "op": "tool",
                "event": "deleted",
                "tool_id": tool["id"],
            }
        painter.send(
            {"op": "stroke.extend", "id": new_id(), "stroke": stroke, "n": 1, "path": [[360, 240]]}
        )
        saved = painter.receive_until("saved")
        assert saved["n"] == 1 and saved["texels_changed"] > 0, saved
    # after a lost connection the client begins again, and repeats messages that may be lost
    with LiveClient(server, "ball") as painter:
        painter.hello()
        painter.send(begin)
        painter.send(first)
        assert painter.receive_until("saved", "problem")["op"] == "saved"
        painter.send(
            {
                "op": "stroke.begin",
                "id": new_id(),
                "stroke": new_id(),
                "layer": "marks",
                "value": 7,
                "camera": camera,
                "radius_px": 30,
                "shape": "left-half",
            }
        )
        problem = painter.receive_until("problem")
        assert problem["status"] == 422 and problem["field"] == "shape", problem
    assert [each["slug"] for each in server.get("/tools").json()["tools"]] == ["dark", "wide"]
    assert server.get("/tools/left-half").status == 404
    gone = server.ok("GET", f"/tools/{tool['id']}")
    assert gone.json()["deleted"] and gone.json()["name"] == "Port side"
    assert server.ok("GET", f"/tools/{tool['id']}/picture").body[:4] == b"\x89PNG"
    for method in ("PATCH", "DELETE"):
        assert (
            server.request(
                method, f"/tools/{tool['id']}", {"name": "x"} if method == "PATCH" else None
            ).status
            == 404
        )


def raster(server, at=None):
    return server.ok("GET", L + "/texels.npy" + (f"?at={at}" if at else "")).body


def test_history(server, camera, story):
    """Undo, redo and earlier states of strokes with a brush shape, before and after kill -9."""
    dark = story.dark
    before = raster(server)
    stroke = {
        "op": "stroke",
        "value": 9,
        "camera": camera,
        "radius_px": 90,
        "path": [[280, 200], [350, 290]],
        "shape": dark["id"],
        "max_angle_deg": 70,
    }
    sequence = server.ok("POST", L + "/edits", stroke).json()["sequence"]
    painted = raster(server)
    assert painted != before
    server.kill()
    server.start()
    assert raster(server) == painted
    newest = server.get(L + "/edits").json()["edits"][0]
    assert (
        newest["shape"] == dark["id"]
        and newest["max_angle_deg"] == 70
        and "depth_bias" not in newest
    ), newest
    server.ok("POST", L + "/undo")
    assert raster(server) == before
    server.request("DELETE", "/tools/dark")
    server.ok("POST", L + "/redo")
    assert (
        raster(server) == painted
        and raster(server, sequence) == painted
        and raster(server, sequence - 1) == before
    )
    # the id still refers to the same shape
    server.ok("POST", M + "/layers", {"name": "Again", "type": "u8", "resolution": 2048})
    server.ok("POST", M + "/layers", {"name": "First", "type": "u8", "resolution": 2048})
    for layer in ("again", "first"):
        server.ok("POST", f"{M}/layers/{layer}/edits", stroke)
    one, two = (
        server.ok("GET", f"{M}/layers/{layer}/texels.npy").body for layer in ("again", "first")
    )
    assert one == two


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
