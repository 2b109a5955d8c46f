"""Snapshots over HTTP: names of states of a model, the rights to change them, restoring from them,
and refusals."""
import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid

M = "/models/sheet"
L = M + "/layers/cracks"
ALL = M + "/snapshots"
MOST = 200


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    return server


@pytest.fixture(scope="module")
def tokens(server):
    return {
        name: server.add_person(name, role)
        for name, role in (
            ("vera", "viewer"),
            ("ada", "annotator"),
            ("bob", "annotator"),
            ("carl", "curator"),
        )
    }


@pytest.fixture(scope="module")
def ask(server, tokens):
    def ask(who, method, path, body=None, **more):
        return server.request(method, path, body, token=tokens[who], **more)

    return ask


@pytest.fixture(scope="module")
def painted(server, tokens):
    camera = camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))

    def stroke(x):
        body = {
            "op": "stroke",
            "value": 1,
            "camera": camera,
            "radius_px": 20,
            "path": [[x, 240]],
        }
        return server.ok("POST", L + "/edits", body, token=tokens["ada"]).json()["sequence"]

    return [stroke(250), stroke(300), stroke(350)]


def refused(answer, status, field=None):
    assert answer.status == status, answer
    problem = answer.json()
    assert problem["detail"] and (field is None or problem.get("field") == field), problem


def test_a_state_before_the_first_edit_has_no_time(ask):
    made = ask("ada", "POST", ALL, {"name": "Nothing yet"})
    assert made.status == 201, made
    assert made.json()["sequence"] == 0 and "state_time" not in made.json(), made.json()
    assert ask("ada", "DELETE", ALL + "/nothing-yet").status == 204


def test_a_state_gets_a_name_and_a_note(ask, painted, story):
    body = {"name": "Before cleaning, May 2026", "text": "With the poultice marks"}
    made = ask("ada", "POST", ALL, body)
    assert made.status == 201, made
    story.newest = newest = made.json()
    assert newest["sequence"] == painted[-1] and newest["user"] == "ada", newest
    assert newest["name"] == body["name"] and newest["text"] == body["text"]
    assert newest["slug"] == "before-cleaning-may-2026"
    assert made.headers["Location"] == f"/api/v1{ALL}/{newest['slug']}"
    assert made.headers["ETag"] == '"v1"'

    earlier = ask("bob", "POST", ALL, {"name": "Earlier", "at": painted[0]}).json()
    assert earlier["sequence"] == painted[0] and earlier["state_time"] < newest["state_time"]
    of_time = ask("bob", "POST", ALL, {"name": "By time", "at": earlier["state_time"]}).json()
    assert of_time["sequence"] == painted[0], of_time
    assert ask("bob", "DELETE", ALL + "/by-time").status == 204

    listed = ask("vera", "GET", ALL).json()
    assert listed == {"snapshots": [newest, earlier], "total": 2}, listed
    read = ask("vera", "GET", f"{ALL}/{newest['id']}")
    assert read.json() == newest
    at = f"{ALL}/{newest['slug']}"
    tag = {"If-None-Match": ask("vera", "GET", at).headers["ETag"]}
    again = ask("vera", "GET", at, headers=tag)
    assert again.status == 304, again


def test_open_pages_are_told(server, ask):
    with LiveClient(server, "sheet") as live:
        live.hello()
        made = ask("ada", "POST", ALL, {"name": "Told"}).json()
        told = {"op": "snapshot", "snapshot": made["id"], "user": "ada"}
        assert live.receive_until("snapshot") == {**told, "event": "created"}
        ask("ada", "PATCH", ALL + "/told", {"text": "To all"})
        assert live.receive_until("snapshot") == {**told, "event": "changed"}
        ask("carl", "DELETE", ALL + "/told")
        assert live.receive_until("snapshot") == {**told, "event": "deleted", "user": "carl"}


def test_authors_and_curators_rename_and_delete(ask, story):
    at = f"{ALL}/{story.newest['slug']}"
    refused(ask("vera", "POST", ALL, {"name": "Mine"}), 403)
    refused(ask("vera", "PATCH", at, {"name": "Mine"}), 403)
    refused(ask("bob", "PATCH", at, {"name": "Mine"}), 403)
    refused(ask("bob", "DELETE", at), 403)
    renamed = ask("ada", "PATCH", at, {"name": "Before cleaning"}, headers={"If-Match": '"v1"'})
    assert renamed.status == 200 and renamed.headers["ETag"] == '"v2"', renamed
    assert renamed.json()["slug"] == story.newest["slug"]
    assert renamed.json()["sequence"] == story.newest["sequence"]
    refused(ask("ada", "PATCH", at, {"text": "Late"}, headers={"If-Match": '"v1"'}), 412)
    noted = ask("carl", "PATCH", at, {"text": ""})
    assert noted.status == 200 and noted.json()["text"] == "", noted
    assert ask("carl", "DELETE", ALL + "/earlier").status == 204
    refused(ask("carl", "GET", ALL + "/earlier"), 404)


def test_a_layer_is_restored_to_a_snapshot(server, ask, painted, story):
    then = server.get(L + "/statistics").json()["texels"]
    fill = {"op": "fill", "erase": True, "mode": "where", "where": "true"}
    server.ok("POST", L + "/edits", fill)
    assert server.get(L + "/statistics").json()["texels"] == 0
    state = ask("vera", "GET", f"{ALL}/{story.newest['slug']}").json()["sequence"]
    counted = ask("vera", "POST", L + "/difference", {"from": state}).json()
    assert counted["texels"] == then, counted
    assert ask("ada", "POST", L + "/restore", {"sequence": state}).status == 200
    assert server.get(L + "/statistics").json()["texels"] == then


def test_malformed_snapshots_are_refused(ask):
    for body, field in (
        ({}, "name"),
        ({"name": ""}, "name"),
        ({"name": "x" * 201}, "name"),
        ({"name": "x", "text": "x" * 10_001}, "text"),
        ({"name": "x", "at": 10**9}, "at"),
        ({"name": "x", "at": -1}, "at"),
        ({"name": "x", "at": "yesterday"}, "at"),
        ({"name": "x", "sequence": 1}, "sequence"),
    ):
        refused(ask("ada", "POST", ALL, body), 422, field)
    refused(ask("ada", "PATCH", ALL + "/nothing", {"name": "x"}), 404)
    refused(ask("ada", "POST", "/models/nothing/snapshots", {"name": "x"}), 404)


def test_a_model_has_a_limited_number_of_snapshots(ask):
    total = ask("vera", "GET", ALL).json()["total"]
    for n in range(total, MOST):
        assert ask("ada", "POST", ALL, {"name": f"State {n}"}).status == 201
    refused(ask("ada", "POST", ALL, {"name": "One too many"}), 409)
    page = ask("vera", "GET", ALL + "?limit=50&offset=150").json()
    assert len(page["snapshots"]) == 50 and page["total"] == MOST
