"""The activity of a project over HTTP: every kind of line, its author, pages, visibility, and the
lines of a deleted user."""
import urllib.parse

import pytest
from support.browsers import join
from support.cameras import camera_from
from support.meshes import folded_grid

M = "/models/sheet"
FEED = "/projects/default/activity"


class Site:
    def __init__(self, server):
        self.server = server
        self.tokens = {
            name: server.add_person(name, role)
            for name, role in (("vera", "viewer"), ("ada", "annotator"), ("carl", "curator"))
        }

    def ok(self, who, method, path, body=None, **more):
        return self.server.ok(method, path, body, token=self.tokens[who], **more)

    def feed(self, who="vera", **parameters):
        return self.ok(
            who, "GET", FEED + ("?" + urllib.parse.urlencode(parameters) if parameters else "")
        ).json()

    def lines(self, **parameters):
        return [
            (line.get("user"), line["kind"], line["op"], line.get("name"), line["count"])
            for line in self.feed(**parameters)["activity"]
        ]


@pytest.fixture(scope="module")
def site(server):
    return Site(server)


def test_whatever_people_do_has_its_line(site):
    """Every action of a user has a line. The newest is first."""
    site.server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    site.ok(
        "carl",
        "POST",
        M + "/layers",
        {"name": "Cracks", "kind": "numeric", "type": "u8", "resolution": 2048},
    )
    site.ok(
        "carl",
        "PATCH",
        M + "/layers/cracks",
        {"description": "What was seen by eye", "opacity": 0.5},
    )
    stroke = {
        "op": "stroke",
        "value": 3,
        "camera": camera_from(site.server.get(M).json(), (0, 0, 1), up=(0, 1, 0)),
        "radius_px": 8,
    }
    for x in (300, 320, 340):
        site.ok("ada", "POST", M + "/layers/cracks/edits", {**stroke, "path": [[x, 200], [x, 260]]})
    site.ok("ada", "POST", M + "/layers/cracks/undo")
    site.ok(
        "ada",
        "POST",
        M + "/layers/cracks/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 1},
    )
    site.ok(
        "carl",
        "POST",
        M + "/layers",
        {"name": "Units", "kind": "database", "type": "u16", "resolution": 2048},
    )
    site.ok("ada", "POST", "/tables/units/records", {"values": {"name": "SU 1"}})
    site.ok("ada", "POST", "/tables/units/records", {"values": {"name": "SU 2"}})
    site.ok("carl", "POST", "/tables/units/columns", {"name": "Depth", "kind": "numeric"})
    thread = site.ok(
        "ada", "POST", M + "/comments", {"text": "Is this a crack?", "position": [50, 50, 0]}
    ).json()
    site.ok("vera", "GET", M + "/comments")  # reading adds no line
    site.ok("carl", "POST", f"/comments/{thread['id']}/replies", {"text": "Yes"})
    site.ok(
        "carl",
        "PATCH",
        f"/comments/{thread['id']}",
        {"state": "resolved"},
        headers={"If-Match": "*"},
    )
    site.ok("carl", "DELETE", M + "/layers/units", headers={"If-Match": "*"})
    camera = camera_from(site.server.get(M).json(), (0, 0, 1), up=(0, 1, 0))
    site.ok("ada", "POST", M + "/views", {"name": "Front", "camera": camera})
    site.ok(
        "ada", "PATCH", M + "/views/front", {"text": "Where it broke"}, headers={"If-Match": "*"}
    )
    site.ok(
        "carl",
        "POST",
        M + "/tours",
        {
            "name": "The sheet",
            "languages": ["en"],
            "stops": [{"view": "front", "title": {"en": "Here"}}],
        },
    )
    site.ok("carl", "DELETE", M + "/tours/the-sheet", headers={"If-Match": "*"})
    assert site.lines(limit=100) == [
        ("carl", "tour", "deleted", "The sheet", 1),
        ("carl", "tour", "created", "The sheet", 1),
        ("ada", "view", "changed", "Front", 1),
        ("ada", "view", "created", "Front", 1),
        ("carl", "layer", "deleted", "Units", 1),
        ("carl", "comment", "resolved", None, 1),
        ("carl", "comment", "replied", None, 1),
        ("ada", "comment", "written", None, 1),
        ("carl", "columns", "create-column", "Units", 1),
        ("ada", "records", "records", "Units", 2),
        ("carl", "layer", "created", "Units", 1),
        ("carl", "table", "created", "Units", 1),
        ("ada", "edit", "fill", "Cracks", 1),
        ("ada", "edit", "undo", "Cracks", 1),
        ("ada", "edit", "stroke", "Cracks", 3),
        ("carl", "layer", "changed", "Cracks", 1),
        ("carl", "layer", "created", "Cracks", 1),
        ("owner", "model", "created", "Sheet", 1),
    ], site.lines(limit=100)
    told = site.feed(limit=100)["activity"]
    assert told[2]["changed"] == ["text"] and "Sheet" in told[2]["model_name"], told[2]
    feed = told[4:]
    model = site.ok("vera", "GET", M).json()["id"]
    cracks = site.ok("vera", "GET", M + "/layers/cracks").json()["id"]
    strokes = feed[10]
    assert (strokes["model"], strokes["model_name"], strokes["layer"]) == (
        model,
        "Sheet",
        cracks,
    ), strokes
    edits = [
        edit
        for edit in site.ok("vera", "GET", M + "/layers/cracks/edits").json()["edits"]
        if edit["op"] == "stroke"
    ]
    assert strokes["texels"] == sum(edit["texels_changed"] for edit in edits) > 0, (strokes, edits)
    assert abs(strokes["area_m2"] - sum(edit["area_m2"] for edit in edits)) < 1e-12
    assert strokes["begun"] == edits[-1]["time"] and strokes["time"] == edits[0]["time"], (
        strokes,
        edits,
    )
    assert feed[11]["changed"] == ["description", "opacity"]
    assert (feed[3]["text"], feed[3]["comment"]) == ("Is this a crack?", thread["id"])
    assert "layer" not in feed[0] and feed[0]["model"] == model, "it is not there any more"


def test_pages(site):
    """Pages of every size together form the whole list. Invalid parameters are refused."""
    whole = site.feed(limit=1000)
    assert "next" not in whole
    for limit in (1, 4):
        read, before = [], {}
        while True:
            page = site.feed(limit=limit, **before)
            assert len(page["activity"]) <= limit
            read += page["activity"]
            if "next" not in page:
                break
            before = {"before": page["next"]}
        assert read == whole["activity"], limit
    of_model = [line for line in whole["activity"] if "model" in line]
    assert site.feed(limit=1000, model="sheet")["activity"] == of_model
    for parameters, status, field in (
        ({"before": "7"}, 422, "before"),
        ({"before": "7-"}, 422, "before"),
        ({"before": "-7-1"}, 422, "before"),
        ({"before": "9" * 17 + "-1"}, 422, "before"),
        ({"model": "nothing"}, 422, "model"),
        ({"limit": 0}, 422, "limit"),
    ):
        refused = site.server.request(
            "GET", FEED + "?" + urllib.parse.urlencode(parameters), token=site.tokens["vera"]
        )
        assert refused.status in (400, status) and refused.json().get("field") == field, (
            parameters,
            refused,
        )
    assert site.feed(before=f"{'9' * 16}-{'9' * 15}")["activity"], "that is after everything"
    assert (
        site.server.request("GET", "/projects/nowhere/activity", token=site.tokens["vera"]).status
        == 404
    )


def test_members(site):
    """Only curators see roles. Guests see only the activity of their projects."""
    gus = join(
        site.server, site.server.ok("POST", "/users", {"user": "gus", "role": "guest"}).json()
    )
    assert gus.request("GET", FEED).status == 404
    site.server.ok("PUT", "/projects/default/members/gus", {"role": "viewer"})
    seen = gus.request("GET", FEED).json()
    assert seen["activity"] and seen == site.feed("vera")
    told = site.feed("carl")["activity"][0]
    assert (told["user"], told["kind"], told["op"], told["person"], told["role"]) == (
        "owner",
        "member",
        "added",
        "gus",
        "viewer",
    ), told
    assert all(line["kind"] != "member" for line in site.feed("vera", limit=1000)["activity"])


def test_deleted_people(site):
    """The lines of a deleted user remain, with an anonymous name."""
    before = site.feed("carl", limit=1000)["activity"]
    for name in ("ada", "gus"):
        site.server.ok("DELETE", f"/users/{name}")
    after = site.feed("carl", limit=1000)["activity"]
    assert [line["id"] for line in after] == [line["id"] for line in before]
    names = {line.get("user") for line in after} | {line.get("person") for line in after}
    assert not names & {"ada", "gus"} and any(
        name and name.startswith("former-") for name in names
    ), names


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
