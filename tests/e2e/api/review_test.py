"""Edits that wait for review, over HTTP and live: the right to decide, notifications, and
refusals."""
import hashlib
import uuid

import pytest
from support.browsers import uncoloured
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
L = M + "/layers/cracks"


def new():
    return str(uuid.uuid4())


def texels(server):
    return hashlib.sha256(server.ok("GET", f"{L}/texels.npy").body).hexdigest()


def waiting(server, token=True, layer=L, **query):
    path = (
        layer
        + "/review"
        + ("?" + "&".join(f"{key}={value}" for key, value in query.items()) if query else "")
    )
    return server.ok("GET", path, token=token).json()


def entry(server, sequence):
    return next(
        each
        for each in server.ok("GET", L + "/edits?limit=1000").json()["edits"]
        if each["sequence"] == sequence
    )


class Site:
    """Anna and Ben are annotators, Cleo is a curator, and Vera is a viewer."""

    def __init__(self, server):
        self.server = server
        for name, role in (
            ("anna", "annotator"),
            ("ben", "annotator"),
            ("cleo", "curator"),
            ("vera", "viewer"),
        ):
            setattr(self, name, server.add_person(name, role))

    def dab(self, camera, x, token, **more):
        stroke = {
            "op": "stroke",
            "value": 7,
            "camera": camera,
            "radius_px": 9,
            "path": [[x, 240]],
            **more,
        }
        return self.server.ok("POST", L + "/edits", stroke, token=token).json()

    def decide(self, decision, token, **more):
        return self.server.request(
            "POST", L + "/review", {"decision": decision, **more}, token=token
        )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    return server


@pytest.fixture(scope="module")
def camera(server):
    return camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))


@pytest.fixture(scope="module")
def site(server):
    return Site(server)


def test_an_edit_waits_and_is_decided(site, camera):
    server = site.server
    clear = texels(server)
    before = server.ok("GET", L).json()
    assert before["review"] is False
    assert "provisional" not in site.dab(camera, 250, site.anna)
    for token in (site.anna, site.vera):
        assert server.request("PATCH", L, {"review": True}, token=token).status == 403
    assert server.ok("PATCH", L, {"review": True}, token=site.cleo).json()["review"] is True

    first = site.dab(camera, 300, site.anna)
    assert first["provisional"] is True and first["texels_changed"] > 0, first
    second = site.dab(camera, 340, site.ben)
    assert "provisional" not in site.dab(camera, 380, site.cleo)
    queue = waiting(server, site.anna)
    assert [each["sequence"] for each in queue["strokes"]] == [
        first["sequence"],
        second["sequence"],
    ] and queue["total"] == 2, queue
    assert [uncoloured(person) for person in queue["people"]] == [
        {"user": "anna", "strokes": 1},
        {"user": "ben", "strokes": 1},
    ], queue
    assert (
        queue["strokes"][0]["op"] == "stroke"
        and queue["strokes"][0]["camera"]["width"] == camera["width"]
    ), queue
    assert waiting(server, site.vera, user="ben")["total"] == 1
    assert [each["sequence"] for each in waiting(server, limit=1, offset=1)["strokes"]] == [
        second["sequence"]
    ]
    assert entry(server, first["sequence"])["review"] == "pending" and "review" not in entry(
        server, second["sequence"] + 1
    )

    for token in (site.anna, site.vera):
        assert site.decide("accept", token, all=True).status == 403
    then = texels(server)
    accepted = site.decide("accept", site.cleo, user="anna", reason="As on the plan")
    assert (
        accepted.status == 200
        and accepted.json()["texels_changed"] == 0
        and "provisional" not in accepted.json()
    ), accepted
    assert texels(server) == then and waiting(server)["total"] == 1
    told = entry(server, first["sequence"])
    assert (
        told["review"] == "accepted"
        and told["reviewer"]["user"] == "cleo"
        and told["reviewer"]["reason"] == "As on the plan"
    ), told
    refused = server.post(L + "/undo", token=site.anna)
    assert refused.status == 409 and "waits for review" in refused.json()["detail"], refused

    rejected = site.decide("reject", site.cleo, edits=[second["sequence"]])
    assert rejected.status == 200 and rejected.json()["texels_changed"] > 0, rejected
    assert texels(server) not in (then, clear) and waiting(server)["total"] == 0
    assert entry(server, second["sequence"])["in_force"] is False
    assert server.post(L + "/redo", token=site.ben).status == 409
    assert site.decide("reopen", site.cleo, edits=[second["sequence"]]).status == 200
    assert texels(server) == then and waiting(server)["total"] == 1
    assert "reviewer" not in entry(server, second["sequence"])
    server.ok("POST", L + "/undo", token=site.ben)
    assert waiting(server)["total"] == 0
    server.ok("POST", L + "/redo", token=site.ben)
    assert waiting(server)["total"] == 1

    lines = server.ok("GET", "/projects/default/activity").json()["activity"]
    assert {"accept", "reject", "reopen"} <= {
        line["op"] for line in lines if line.get("user") == "cleo"
    }, lines
    assert any("review" in line.get("changed", []) for line in lines), lines
    print("life: ok", flush=True)


def test_refusals(site):
    server = site.server
    then, count = texels(server), waiting(server)["total"]
    for body, field in (
        ({}, None),
        ({"decision": "accept"}, None),
        ({"decision": "maybe", "all": True}, "decision"),
        ({"decision": "accept", "all": False}, "all"),
        ({"decision": "accept", "all": True, "user": "ben"}, None),
        ({"decision": "accept", "edits": []}, "edits"),
        ({"decision": "accept", "edits": ["1"]}, None),
        ({"decision": "accept", "edits": [0]}, None),
        ({"decision": "accept", "edits": [1] * 10001}, "edits"),
        ({"decision": "accept", "user": ""}, "user"),
        ({"decision": "reject", "all": True, "reason": "x" * 1001}, "reason"),
        ({"decision": "reopen", "all": True}, "edits"),
        ({"decision": "reopen", "user": "ben"}, "edits"),
        ({"decision": "accept", "all": True, "more": 1}, "more"),
    ):
        answer = server.post(L + "/review", body, token=site.cleo)
        assert answer.status == 422 and (
            field is None or answer.json().get("field", "").startswith(field)
        ), (body, answer)
    for body in ({"edits": [1]}, {"edits": [999999]}, {"user": "nobody"}):
        assert site.decide("accept", site.cleo, **body).status == 409, body
    assert site.decide("reopen", site.cleo, edits=[1]).status == 409
    for query in ("user=", "limit=-1", "what=1", "user=" + "x" * 201):
        assert server.get(f"{L}/review?{query}").status in (400, 422), query
    assert (
        server.post(M + "/layers/nothing/review", {"decision": "accept", "all": True}).status == 404
    )
    assert server.get(M + "/layers/nothing/review").status == 404
    assert server.request("PATCH", L, {"review": "yes"}).status == 422
    assert (texels(server), waiting(server)["total"]) == (then, count)

    # a repeat gets the first response and decides nothing
    body, key = {"decision": "accept", "all": True}, {"Idempotency-Key": "once"}
    first = server.request("POST", L + "/review", body, headers=key, token=site.cleo)
    again = server.request("POST", L + "/review", body, headers=key, token=site.cleo)
    assert first.status == again.status == 200 and first.json() == again.json(), (first, again)
    assert (
        server.request(
            "POST", L + "/review", {"decision": "reject", "all": True}, headers=key, token=site.cleo
        ).status
        == 422
    )

    # a user gets no review queue for layers that the user cannot see
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Graves", "type": "u8", "review": True, "visibility": "team"},
    )
    server.ok(
        "POST",
        M + "/layers/graves/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 1},
        token=site.anna,
    )
    assert server.get(M + "/layers/graves/review", token=site.vera).status == 404
    assert waiting(server, site.ben, M + "/layers/graves")["strokes"][0]["op"] == "fill"
    server.ok("DELETE", M + "/layers/graves")
    print("refusals: ok", flush=True)


def test_live(site, camera):
    server = site.server
    with LiveClient(server, "sheet", token=site.anna) as anna, LiveClient(
        server, "sheet", token=site.ben
    ) as ben:
        assert {each["slug"]: each["review"] for each in anna.hello()["layers"]}["cracks"] is True
        ben.hello()
        stroke = new()
        anna.send(
            {
                "op": "stroke.begin",
                "id": new(),
                "stroke": stroke,
                "layer": "cracks",
                "value": 9,
                "camera": camera,
                "radius_px": 9,
            }
        )
        for n in range(2):
            anna.send(
                {
                    "op": "stroke.extend",
                    "id": new(),
                    "stroke": stroke,
                    "n": n,
                    "path": [[200 + 10 * n, 200]],
                }
            )
            assert anna.receive_until("applied")["provisional"] is True
            saved = anna.receive_until("saved", "problem")
            assert saved["op"] == "saved" and saved["provisional"] is True, saved
        event = ben.receive_until("layer")
        assert event["provisional"] is True and event["user"] == "anna", event
        queue = waiting(server)
        assert (
            queue["total"] == 1
            and queue["strokes"][0]["sequence"] + 1 == queue["strokes"][0]["last"]
        ), queue
        assert site.decide("reject", site.cleo, all=True, reason="Not a crack").status == 200
        for live in (anna, ben):
            event = live.receive_until("layer")
            while "review" not in event:
                event = live.receive_until("layer")
            assert (
                event["review"]
                == {"decision": "reject", "authors": ["anna"], "reason": "Not a crack"}
                and event["user"] == "cleo"
            ), event
        anna.send({"op": "redo", "id": new(), "layer": "cracks"})
        assert anna.receive_until("saved", "problem")["status"] == 409
    print("live: ok", flush=True)


def test_restart(site, camera):
    server = site.server
    made = site.dab(camera, 360, site.anna)
    picture = lambda: hashlib.sha256(
        server.ok("POST", M + "/frame", {"camera": camera, "format": "png"}).body
    ).hexdigest()
    marked = picture()
    assert server.stop() == 0
    server.start()
    assert picture() == marked, "the marks are not those of the journal"
    assert site.decide("accept", site.cleo, edits=[made["sequence"]]).status == 200
    assert picture() != marked
    print("restart: ok", flush=True)
