"""Visibility: private layers, columns and attachments do not exist for viewers and annotators."""
import hashlib
import types

import pytest
from support.addresses import query
from support.live_client import LAST_RECTANGLE, LiveClient
from support.sql_reader import Reader, free_port
from support.strata_server import StrataServer, wait_for
from support.visibility_site import (
    CELL,
    COLUMN,
    KEYS,
    LAYER,
    PNG,
    VALUE,
    M,
    leaks,
    make_site,
    sweep,
    words,
)


def still(connection):
    """Returns the bytes of a whole frame at rest."""
    parts = []
    while True:
        frame = connection.receive_until("frame")
        parts.append(frame["payload"])
        if frame["flags"] & LAST_RECTANGLE:
            if frame["flags"] & 2:
                return hashlib.sha256(b"".join(parts)).hexdigest()
            parts = []


def message_of_layer(connection):
    return connection.receive_until("layer")


@pytest.fixture(scope="module")
def port():
    return free_port()


@pytest.fixture(scope="module")
def server(port):
    with StrataServer(options=["--sql-listen", f"127.0.0.1:{port}"]) as server:
        yield server


@pytest.fixture(scope="module", autouse=True)
def site(server):
    camera, before, public, hidden, thread = make_site(server)
    return types.SimpleNamespace(
        camera=camera, before=before, public=public, hidden=hidden, thread=thread
    )


@pytest.fixture(scope="module")
def camera(site):
    return site.camera


@pytest.fixture(scope="module")
def public(site):
    return site.public


@pytest.fixture(scope="module")
def thread(site):
    return site.thread


@pytest.fixture(scope="module")
def viewer(server):
    return server.add_person("viewer", "viewer")


@pytest.fixture(scope="module")
def annotator(server):
    return server.add_person("annotator", "annotator")


@pytest.fixture(scope="module")
def curator(server):
    return server.add_person("curator", "curator")


@pytest.fixture
def reader(server, port):
    return Reader(server, port)


def picture(server, camera, token):
    return server.ok("POST", M + "/frame", {"camera": camera, "format": "png"}, token=token).body


def test_curators_are_told_the_secrets(server, site, curator):
    answered, told = sweep(server, curator, words(server, site.public), site.camera)
    assert answered > 100 and len(told) > 15, (answered, sorted(told))
    assert picture(server, site.camera, curator) != site.before


# The attempts of faults/security_attempts_test.py search the other responses of the contract for
# secrets, as a viewer and as an annotator, on a site like this one.
def test_the_picture_does_not_show_the_secrets(server, site, viewer, annotator):
    for token in (viewer, annotator):
        assert picture(server, site.camera, token) == site.before


def test_undo_shows_nothing(server, viewer, annotator):
    """The journal of a table does not contain a hidden column, and undo does not show it."""
    for token in (viewer, annotator):
        answer = server.get("/tables/finds/edits", token=token)
        assert not leaks(answer.body), answer
    assert leaks(server.get("/tables/finds/edits").body)
    server.ok("POST", "/tables/finds/undo")
    server.ok("POST", "/tables/finds/redo")
    columns = server.get("/tables/finds/columns", token=viewer).json()["columns"]
    assert COLUMN not in [column["slug"] for column in columns], columns


def test_live(server, viewer, annotator, camera, thread):
    """A change of visibility takes effect on an open connection immediately."""

    def message(connection, *ops):
        told = connection.receive_until(*ops)
        assert not leaks(
            repr({key: value for key, value in told.items() if key != "payload"}).encode()
        ), told
        return told

    with LiveClient(server, "sheet", token=viewer) as eyes, LiveClient(
        server, "sheet", token=annotator
    ) as hand:
        for connection in (eyes, hand):
            welcome = connection.hello(dpr=1, accept=["jpeg"])
            assert not leaks(repr(welcome).encode()) and {
                layer["slug"] for layer in welcome["layers"]
            } == {"cracks", "finds"}, welcome
            connection.send({"op": "camera", "seq": 1, "moving": False, **camera})
        before = still(eyes)
        # edits to the secret layer are not announced, and neither are the cells of its records
        server.ok(
            "POST",
            f"{M}/layers/{LAYER}/edits",
            {"op": "fill", "mode": "where", "where": "x < 30", "value": VALUE},
        )
        server.ok("PATCH", "/tables/finds/records/1", {"values": {COLUMN: CELL + " twice"}})
        for connection in (eyes, hand):
            told = message(connection, "record", "layer")
            assert (
                told["op"] == "record"
                and told["key"] == 1
                and COLUMN not in told["record"]["values"]
            ), told
            connection.send({"op": "layers", "layers": [{"layer": LAYER, "visible": True}]})
            assert connection.receive_until("problem")["status"] == 404
            connection.send(
                {
                    "op": "pick",
                    "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b11",
                    "camera": camera,
                    "x": 320,
                    "y": 240,
                }
            )
            message(connection, "picked")
        # the layer becomes visible, and is then removed again
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "team"})
        shown = hand.receive_until("layer")
        assert shown["event"] == "created" and shown["layer"]["slug"] == LAYER, shown
        assert (
            hand.receive_until("comment")["event"] == "changed"
        ), "the thread about the layer is seen with it"
        hand.send(
            {
                "op": "stroke.begin",
                "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b01",
                "stroke": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b02",
                "layer": LAYER,
                "value": 1,
                "camera": camera,
                "radius_px": 8,
            }
        )
        hand.send(
            {
                "op": "stroke.extend",
                "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b03",
                "stroke": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b02",
                "n": 0,
                "path": [[300, 200], [310, 200]],
            }
        )
        hand.receive_until("saved")
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "private"})
        gone = hand.receive_until("layer")
        while gone["event"] == "edited":
            gone = hand.receive_until("layer")
        assert gone["event"] == "deleted" and "layer" not in gone, gone
        told = hand.receive_until("comment")
        assert (
            told["event"] == "deleted" and told["comment_id"] == thread and "comment" not in told
        ), told
        hand.send(
            {
                "op": "stroke.extend",
                "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b04",
                "stroke": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b02",
                "n": 1,
                "path": [[320, 200]],
            }
        )
        assert (
            hand.receive_until("problem", "saved")["status"] == 404
        ), "a stroke goes on over a layer that is not seen any more"
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "public"})
        shown = message_of_layer(eyes)
        assert shown["event"] == "created" and shown["layer"]["slug"] == LAYER, shown
        wait_for(lambda: still(eyes) != before, "the picture to show the layer")
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "private"})
        assert message_of_layer(eyes)["event"] == "deleted"
        wait_for(lambda: still(eyes) == before, "the picture to be as if there was no such layer")


def test_sql(server, reader):
    """Analysts see only public content."""
    assert {row["slug"] for row in reader.rows("SELECT slug FROM layers")} == {"cracks", "finds"}
    for view in ("layers", "areas", "edits", "record_edits", '"Finds"'):
        done = reader.run(f"SELECT * FROM {view}")
        assert done.returncode == 0 and not leaks(done.stdout.encode()), (view, done)
    server.ok("PATCH", f"/tables/finds/columns/{COLUMN}", {"visibility": "team"})
    assert not leaks(reader.run('SELECT * FROM "Finds"').stdout.encode())
    server.ok("PATCH", f"/tables/finds/columns/{COLUMN}", {"visibility": "public"})
    assert leaks(reader.run('SELECT * FROM "Finds"').stdout.encode())
    server.ok("PATCH", f"/tables/finds/columns/{COLUMN}", {"visibility": "private"})
    assert not leaks(reader.run('SELECT * FROM "Finds"').stdout.encode())


def test_source(server, viewer, annotator, curator):
    """The scan's files, its mesh and its full-size images need a separate right."""
    doors = [M + "/source/sheet.ply", M + "/vertices.ply"]
    look = server.ok("POST", query(M + "/looks", name="UV"), PNG).json()["slug"]
    doors.append(f"{M}/looks/{look}/picture")
    for least, expected in (
        ("annotator", (403, 200, 200)),
        ("curator", (403, 403, 200)),
        ("viewer", (200, 200, 200)),
        ("annotator", (403, 200, 200)),
    ):
        assert server.ok("PATCH", M, {"source_download": least}).json()["source_download"] == least
        for door in doors:
            assert (
                tuple(
                    server.get(door, token=token).status for token in (viewer, annotator, curator)
                )
                == expected
            ), (least, door)
        assert server.get(f"{M}/looks/{look}/picture?thumbnail=96", token=viewer).status == 200
    assert server.request("PATCH", M, {"source_download": "viewer"}, token=annotator).status == 403
    assert server.request("PATCH", M, {"source_download": "owner"}).status == 422


def test_ladder(server, viewer, annotator, curator, public):
    """Each role sees the content of its visibility, also after changes. Earlier visible states are
    hidden, too."""

    def seen(path):
        return tuple(
            server.get(path, token=token).status == 200 for token in (viewer, annotator, curator)
        )

    by_visibility = {
        "public": (True, True, True),
        "team": (False, True, True),
        "private": (False, False, True),
    }
    layer, column, file = (
        M + "/layers/cracks",
        "/tables/finds/columns/depth",
        f"/attachments/{public['id']}",
    )
    for visibility in ("team", "private", "public"):
        for path in (layer, column, file):
            assert server.request(
                "PATCH", path, {"visibility": visibility}, token=viewer
            ).status in (403, 404)
            assert server.request(
                "PATCH", path, {"visibility": visibility}, token=annotator
            ).status in (403, 404), path
            server.ok("PATCH", path, {"visibility": visibility}, token=curator)
        expected = by_visibility[visibility]
        assert (
            seen(layer)
            == seen(layer + "/edits")
            == seen(layer + "/texels.npy")
            == seen(file)
            == seen(file + "?thumbnail=64")
            == expected
        ), visibility
        assert (
            seen(column + "/classes")
            == seen(query("/tables/finds/records", sortby="depth"))
            == expected
        ), visibility
        for token, sees in zip((viewer, annotator, curator), expected):
            assert (
                "depth" in server.get("/tables/finds/records/1?at=1", token=token).json()["values"]
            ) == sees, visibility
            assert (
                "plan.png"
                in str(server.get("/tables/finds/records/1/attachments", token=token).json())
            ) == sees, visibility
    # a user who attaches a file sees it, and chooses its visibility
    mine = server.ok(
        "POST",
        query("/tables/finds/records/2/attachments", name="mine.png", visibility="private"),
        PNG,
        token=annotator,
    ).json()["attachments"][0]
    path = f"/attachments/{mine['id']}"
    assert seen(path) == (False, True, True)
    other = server.add_person("other", "annotator")
    assert (
        server.get(path, token=other).status
        == server.request("PATCH", path, {"visibility": "public"}, token=other).status
        == server.request("DELETE", path, token=other).status
        == 404
    )
    server.ok("PATCH", path, {"visibility": "team"}, token=annotator)
    assert server.get(path, token=other).status == 200 and seen(path) == (False, True, True)
    # a cell keeps a hidden file when a user who cannot see the file writes the cell
    cell = server.get("/tables/finds/records/1", token=viewer).json()["values"]["photo"]
    assert len(cell) == 2, "ids of files stay in their cells, and tell nothing"


def test_nothing_hidden_shows_through(server):
    """The server refuses every operation that would show content of a private source to more
    users."""

    def refused(status, method, path, body, field):
        answer = server.request(method, path, body)
        assert (
            answer.status == status
            and answer.json()["field"] == field
            and "too many people" in answer.json()["title"]
        ), answer

    refused(
        422, "POST", M + "/layers", {"name": "Sum", "expression": f'"{LAYER}" + 1'}, "expression"
    )
    refused(
        422,
        "POST",
        M + "/layers",
        {"name": "Sum", "expression": f"if(finds.\"{COLUMN}\" = 'x', 1, 0)"},
        "expression",
    )
    refused(
        422,
        "POST",
        f"{M}/layers/cracks/edits",
        {"op": "fill", "mode": "where", "where": f'"{LAYER}" > 0', "value": 1},
        "where",
    )
    by_column = {"mode": "categorical", "points": [], "column": COLUMN}
    refused(422, "PATCH", M + "/layers/finds", {"palette": by_column}, "palette.column")
    server.ok("PATCH", f"{M}/layers/{KEYS}", {"palette": by_column})
    refused(422, "PATCH", f"{M}/layers/{KEYS}", {"visibility": "team"}, "palette.column")
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Sum", "expression": f'"{LAYER}" + finds.depth', "visibility": "private"},
    )
    refused(422, "PATCH", M + "/layers/sum", {"visibility": "team"}, "expression")
    server.ok("PATCH", M + "/layers/sum", {"expression": "cracks + finds.depth"})
    server.ok("POST", M + "/layers/sum/compute")
    server.ok("PATCH", M + "/layers/sum", {"visibility": "public"})
    refused(409, "PATCH", M + "/layers/cracks", {"visibility": "private"}, "visibility")
    refused(409, "PATCH", "/tables/finds/columns/depth", {"visibility": "team"}, "visibility")
    server.ok("PATCH", M + "/layers/finds", {"palette": {**by_column, "column": "name"}})
    refused(409, "PATCH", "/tables/finds/columns/name", {"visibility": "private"}, "visibility")
    server.ok("DELETE", M + "/layers/sum")
    for body in (
        {"visibility": "private", "name": "Both"},
        {"visibility": "secret"},
        {"visibility": None},
    ):
        assert server.request("PATCH", "/tables/finds/columns/depth", body).status == 422, body
    assert (
        server.post(
            "/tables/finds/columns", {"name": "Must", "required": True, "visibility": "private"}
        ).status
        == 422
    )
    for path in (M + "/layers/cracks", "/models/sheet"):
        assert server.request("PATCH", path, {"visibility": "hidden"}).status == 422


def test_a_thread_outlives_its_layer(server, viewer, annotator, curator, thread):
    server.ok("DELETE", f"{M}/layers/{LAYER}")
    for token, seen in ((viewer, False), (annotator, False), (curator, True)):
        assert (
            str(thread)
            in [
                str(each["id"])
                for each in server.get(M + "/comments", token=token).json()["comments"]
            ]
        ) == seen


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
