"""A day's work with the tables of a project, over HTTP. Two trenches share their units. Records are
written by hand and as CSV. Keys are painted, changed, undone, read at earlier times, and deleted
with their texels. The server refuses invalid input."""
import csv
import io
from concurrent.futures import ThreadPoolExecutor

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import bumpy_ball, folded_grid

CSV = {"Content-Type": "text/csv"}
T = "/tables/units"
NORTH, SOUTH = "/models/north/layers/units", "/models/south/layers/units"


def records(server, path=T, query=""):
    return {
        each["key"]: each["values"]
        for each in server.ok("GET", f"{path}/records{query}").json()["records"]
    }


def area(server, key, path):
    return server.ok("GET", f"{path}/records/{key}").json()["area_m2"]


def make_tables(server):
    condition = server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Condition",
            "labels": {"es": "Estado"},
            "columns": [{"name": "Term", "required": True, "unique": True}],
        },
    )
    assert condition.headers["Location"] == "/api/v1/tables/condition"
    for term in ("sound", "cracked", "lost"):
        server.ok("POST", "/tables/condition/records", {"values": {"term": term}})
    columns = [
        {"name": "Code", "required": True, "unique": True, "labels": {"es": "Código"}},
        {"name": "Depth", "kind": "numeric", "unit": "m", "minimum": 0},
        {"name": "Period", "kind": "period"},
        {"name": "Dug", "kind": "date"},
        {"name": "Soil", "kind": "enumeration", "choices": ["sand", "clay"], "default": "clay"},
        {"name": "Condition", "kind": "term", "target": "condition"},
    ]
    keyed = {"Idempotency-Key": "units"}
    table = server.ok(
        "POST", "/projects/default/tables", {"name": "Units", "columns": columns}, headers=keyed
    ).json()
    again = server.ok(
        "POST", "/projects/default/tables", {"name": "Units", "columns": columns}, headers=keyed
    ).json()
    assert (
        again["id"] == table["id"] and server.get("/projects/default/tables").json()["total"] == 2
    )
    above = server.ok(
        "POST", T + "/columns", {"name": "Above", "kind": "relation", "target": table["id"]}
    ).json()
    assert above["column"]["slug"] == "above" and above["sequence"] == 1
    assert [each["slug"] for each in server.get(T + "/columns").json()["columns"]] == [
        "code",
        "depth",
        "period",
        "dug",
        "soil",
        "condition",
        "above",
    ]
    return table


@pytest.fixture(scope="module")
def cameras(server):
    models = {
        "north": server.import_model(folded_grid(), "north.ply", unit="mm", name="North"),
        "south": server.import_model(bumpy_ball(), "south.ply", unit="mm", name="South"),
    }
    server.ok("POST", "/models/north/layers", {"name": "wet"})
    return {name: camera_from(model, (0, 0, 1), up=(0, 1, 0)) for name, model in models.items()}


@pytest.fixture(scope="module", autouse=True)
def table(server, cameras):
    return make_tables(server)


@pytest.fixture
def live(server):
    with LiveClient(server, "south") as live:
        live.send({"op": "hello", "client": "test", "dpr": 1, "accept": ["jpeg"]})
        live.receive_until("welcome")
        yield live


def test_layers_of_two_models_share_a_table(server, table):
    """Layers of two models can show one table. A layer without a table gets one with the layer's
    name."""
    for model in ("north", "south"):
        layer = server.ok(
            "POST",
            f"/models/{model}/layers",
            {
                "name": "Units",
                "kind": "database",
                "type": "u16",
                "table": "units",
                "resolution": 2048,
            },
        ).json()
        assert layer["table"] == table["id"], layer
    own = server.ok(
        "POST",
        "/models/north/layers",
        {"name": "Samples", "kind": "database", "columns": [{"name": "Number", "kind": "integer"}]},
    ).json()
    assert server.get(f"/tables/{own['table']}").json()["slug"] == "samples"
    bare = server.ok("POST", "/models/north/layers", {"name": "Notes", "kind": "database"}).json()
    assert [each["name"] for each in server.get(f"/tables/{bare['table']}").json()["columns"]] == [
        "Name"
    ]


def test_write_records(server, live):
    first = server.ok(
        "POST",
        T + "/records",
        {"values": {"code": "SU 1", "depth": 0.5, "period": "1560~/1580", "dug": "2024-05-02"}},
    )
    assert first.status == 201 and first.headers["Location"] == "/api/v1/tables/units/records/1"
    record = first.json()
    assert record["values"]["soil"] == "clay" and record["values"]["condition"] is None, record
    told = live.receive_until("record")
    assert (told["event"], told["table"], told["key"], told["record"]) == (
        "created",
        server.get(T).json()["id"],
        1,
        record,
    ), told
    several = server.ok(
        "POST",
        T + "/records",
        {
            "records": [
                {"values": {"code": "SU 2", "above": [1], "condition": 2}},
                {"key": 300, "values": {"code": "SU 300", "period": "-0043"}},
            ]
        },
    ).json()
    assert [each["key"] for each in several["records"]] == [2, 300]
    etag = first.headers["ETag"]
    changed = server.ok(
        "PATCH", T + "/records/1", {"values": {"depth": 0.75}}, headers={"If-Match": etag}
    )
    assert changed.json()["values"]["depth"] == 0.75
    assert (
        server.request(
            "PATCH", T + "/records/1", {"values": {"depth": 9}}, headers={"If-Match": etag}
        ).status
        == 412
    )
    assert (
        server.request(
            "PATCH", T + "/records/1", {"version": record["version"], "values": {"depth": 9}}
        ).status
        == 412
    )
    same = server.ok("PATCH", T + "/records/1", {"values": {"depth": 0.75}})
    assert same.json() == changed.json(), "nothing changed, so nothing is written"
    assert list(records(server, query="?sortby=period")) == [300, 1, 2]
    assert list(records(server, query="?sortby=-code&limit=2")) == [300, 2]
    page = server.ok("GET", T + "/records?limit=1&offset=1")
    assert 'rel="next"' in page.headers["Link"] and page.json()["total"] == 3


def test_paint(server, cameras):
    refused = server.post(
        NORTH + "/edits", {"op": "fill", "mode": "where", "where": "true", "value": 9}
    )
    assert (
        refused.status == 422
        and refused.json()["field"] == "value"
        and "no record 9" in refused.json()["detail"]
    ), refused
    stroke = {"op": "stroke", "camera": cameras["north"], "radius_px": 40, "path": [[320, 240]]}
    server.ok("POST", NORTH + "/edits", {**stroke, "value": 1})
    server.ok(
        "POST", SOUTH + "/edits", {"op": "fill", "mode": "where", "where": "true", "value": 1}
    )
    server.ok("POST", NORTH + "/edits", {**stroke, "value": 2, "path": [[320, 170]]})
    assert area(server, 1, SOUTH) > area(server, 1, NORTH) > 0
    assert (
        list(records(server, NORTH, "?sortby=-area_m2"))[2] == 300 and area(server, 300, NORTH) == 0
    )
    areas = {each["key"]: each for each in server.ok("GET", T + "/areas").json()["areas"]}
    assert sorted(areas) == [1, 2] and all(each["has_record"] for each in areas.values())
    assert len(areas[1]["models"]) == 2 and len(areas[2]["models"]) == 1
    total = sum(model["area_m2"] for model in areas[1]["models"])
    assert (
        abs(areas[1]["area_m2"] - total) < 1e-9
        and abs(total - area(server, 1, NORTH) - area(server, 1, SOUTH)) < 1e-9
    )


def test_paint_live(server, cameras):
    camera = cameras["north"]
    with LiveClient(server, "north") as live:
        live.send({"op": "hello", "client": "test", "dpr": 1, "accept": ["jpeg"]})
        live.receive_until("welcome")
        begin = {"op": "stroke.begin", "layer": "units", "camera": camera, "radius_px": 5}
        ids = [f"00000000-0000-4000-8000-00000000000{n}" for n in range(6)]
        live.send({**begin, "id": ids[0], "stroke": ids[1], "value": 77})
        problem = live.receive_until("problem")
        assert (
            problem["status"] == 422 and problem["field"] == "value" and problem["ref"] == ids[0]
        ), problem
        live.send({**begin, "id": ids[2], "stroke": ids[3], "value": 2})
        live.send(
            {"op": "stroke.extend", "id": ids[4], "stroke": ids[3], "n": 0, "path": [[320, 100]]}
        )
        saved = live.receive_until("saved", "problem")
        assert saved["op"] == "saved", saved


def test_edit_together(server):
    """The editors of a record are shown on all models of the project until they disconnect."""
    table = server.get(T).json()["id"]
    viewer = server.ok("POST", "/me/tokens", {"name": "looks on", "role": "viewer"}).json()[
        "secret"
    ]

    def edit(live, key, **more):
        live.send(
            {"op": "record.edit", "id": "it", "table": table, "key": key, "editing": True, **more}
        )

    def problem(live):
        told = live.receive_until("problem")
        assert told["ref"] == "it", told
        return told["status"], told.get("field")

    with LiveClient(server, "south") as south, LiveClient(
        server, "south", token=viewer
    ) as looks_on:
        own = south.hello()["session"]
        looks_on.hello()
        with LiveClient(server, "north") as north:
            other = north.hello()["session"]
            edit(north, 1)
            for live in (north, south, looks_on):
                assert live.receive_until("record.editors")["records"] == [
                    {"table": table, "key": 1, "session": other, "user": "owner"}
                ]
            edit(north, 2)
            assert [
                live.receive_until("record.editors")["records"][0]["key"]
                for live in (north, south, looks_on)
            ] == [2, 2, 2]
            with LiveClient(server, "south") as late:
                late.hello()
                assert [
                    each["key"] for each in late.receive_until("record.editors")["records"]
                ] == [1, 2]
            edit(south, 1)  # another user already edits the record, so nothing changes
            edit(south, 1, take_over=True)
            for live in (north, south, looks_on):
                assert live.receive_until("record.editors")["records"][0]["session"] == own
            edit(north, 1, editing=False)  # ends this connection's edit
        # a disconnection ends the other edits of that connection
        for live in (south, looks_on):
            assert live.receive_until("record.editors")["records"] == [{"table": table, "key": 2}]
        for message, refusal in (
            ({"key": 987654}, (404, "key")),
            ({"key": 1, "table": 987654}, (404, "table")),
            ({"key": -1}, (422, "key")),
            ({"key": 1, "editing": "yes"}, (422, "editing")),
        ):
            edit(south, **message)
            assert problem(south) == refusal, message
        edit(looks_on, 1)
        assert problem(looks_on) == (403, None)
        edit(south, 1, editing=False)
        assert looks_on.receive_until("record.editors")["records"] == [{"table": table, "key": 1}]
    server.ok("POST", "/projects", {"name": "Elsewhere"})
    server.ok(
        "POST", "/projects/elsewhere/tables", {"name": "Others", "columns": [{"name": "Name"}]}
    )
    others = server.get("/tables/others").json()["id"]
    server.ok("POST", "/tables/others/records", {"values": {"name": "x"}})
    with LiveClient(server, "south") as south:
        south.hello()
        edit(south, 1, table=others)
        assert problem(south) == (404, "table")


def test_delete_painted(server):
    refused = server.request("DELETE", T + "/records/2")
    assert refused.status == 409 and "cm² on Units of North" in refused.json()["detail"], refused
    before = area(server, 1, NORTH), area(server, 2, NORTH)
    server.ok("DELETE", T + "/records/2?texels=reassign&to=1")
    assert abs(area(server, 1, NORTH) - sum(before)) < 1e-9
    assert server.get(T + "/records/2").status == 404
    reused = server.post(T + "/records", {"key": 2, "values": {"code": "x"}})
    assert reused.status == 409 and reused.json()["title"] == "Key already used"
    # the texels belong to the layer; undo restores them, and the record can also be restored
    server.ok("POST", NORTH + "/undo")
    assert [each["has_record"] for each in server.ok("GET", T + "/areas").json()["areas"]] == [
        True,
        False,
    ]
    undone = server.ok("POST", T + "/undo").json()
    assert undone["created"] == [2] and records(server)[2]["above"] == [1], undone
    assert abs(area(server, 2, NORTH) - before[1]) < 1e-9

    in_use = server.request("DELETE", T + "/records/1?texels=clear")
    assert (
        in_use.status == 409
        and in_use.json()["title"] == "Record in use"
        and area(server, 1, SOUTH) > 0
    ), "nothing was cleared"
    server.ok("PATCH", T + "/records/2", {"values": {"above": None}})
    server.ok("DELETE", T + "/records/1?texels=clear")
    assert server.ok("GET", SOUTH + "/statistics").json()["texels"] == 0
    history = server.ok("GET", SOUTH + "/edits").json()["edits"]
    assert history[0]["op"] == "fill" and len(history) == 2
    server.ok("POST", T + "/undo")
    server.ok("POST", SOUTH + "/undo")
    assert area(server, 1, SOUTH) > 0
    # an undo that would delete a painted record is refused
    server.ok("POST", T + "/records", {"key": 400, "values": {"code": "SU 400"}})
    server.ok(
        "POST", SOUTH + "/edits", {"op": "fill", "mode": "where", "where": "true", "value": 400}
    )
    assert server.post(T + "/undo").json()["title"] == "Record has painted texels"
    server.ok("POST", SOUTH + "/undo")
    server.ok("POST", T + "/undo")
    assert 400 not in records(server)


def test_delete_under_a_stroke(server, cameras):
    """If the record that a stroke paints is deleted, the rest of the stroke does not paint the
    record. The stroke continues after the record is restored."""
    camera = cameras["north"]
    server.ok("POST", T + "/records", {"key": 500, "values": {"code": "SU 500"}})
    with LiveClient(server, "north") as live:
        live.send({"op": "hello", "client": "test", "dpr": 1, "accept": ["jpeg"]})
        live.receive_until("welcome")
        ids = [f"00000000-0000-4000-8000-00000000005{n}" for n in range(6)]
        live.send(
            {
                "op": "stroke.begin",
                "layer": "units",
                "camera": camera,
                "radius_px": 8,
                "id": ids[0],
                "stroke": ids[1],
                "value": 500,
            }
        )

        def extend(number, place):
            live.send(
                {
                    "op": "stroke.extend",
                    "id": ids[2 + number],
                    "stroke": ids[1],
                    "n": number,
                    "path": [place],
                }
            )
            return live.receive_until("saved", "problem")

        assert extend(0, [320, 200])["op"] == "saved"
        server.ok("DELETE", T + "/records/500?texels=clear")
        refused = extend(1, [330, 210])
        assert (refused["op"], refused.get("status"), refused.get("field")) == (
            "problem",
            409,
            "value",
        ), refused
        assert 500 not in [each["key"] for each in server.get(NORTH + "/statistics").json()["keys"]]
        assert server.ok("POST", T + "/undo").json()["created"] == [500]
        assert extend(2, [340, 220])["op"] == "saved"
    server.ok("DELETE", T + "/records/500?texels=clear")


def test_past_and_history(server):
    now = server.ok("GET", T).json()["sequence"]
    assert records(server, query="?at=1") == {}
    assert records(server, query="?at=2")[1]["depth"] == 0.5
    assert records(server, query=f"?at={now}") == records(server)
    history = server.ok("GET", T + "/edits?key=1").json()["edits"]
    created = history[-1]
    assert (
        created["op"] == "records"
        and created["user"] == "owner"
        and created["changes"][0]["after"]["exists"] is True
    )
    assert records(server, query="?at=" + created["time"].replace(":", "%3A")) != records(server)
    assert server.get(T + "/records/1?at=1").status == 404
    assert server.get(T + "/records?at=2000-01-01T00:00:00Z").json()["total"] == 0


def test_bulk(server):
    text = server.ok("GET", T + "/records?f=csv").body
    assert text.startswith(b"\xef\xbb\xbfkey,code,depth,"), text[:60]
    rows = list(csv.DictReader(io.StringIO(text.decode("utf-8-sig"))))
    assert [row["code"] for row in rows] == ["SU 1", "SU 2", "SU 300"], rows
    with_comma = server.ok("GET", NORTH + "/records?f=csv&separator=semicolon").body.decode(
        "utf-8-sig"
    )
    assert with_comma.splitlines()[0].endswith(";area_m2") and ";0,75;" in with_comma, with_comma
    # the export can be imported again, and the response reports no change
    unchanged = server.ok("POST", T + "/records", text, headers=CSV).json()
    assert (unchanged["unchanged"], unchanged["sequence"]) == (3, 0), unchanged
    assert (
        server.ok("POST", NORTH + "/records", with_comma.encode(), headers=CSV).json()["unchanged"]
        == 3
    )

    bad = 'key,Código,Depth,Soil,Period\r\n,SU 10,1.5,sand,1560\r\n,SU 11,deep,sand,1560\r\n,"SU\r\n12",1,mud,\r\n,SU 10,1,sand,circa\r\n1,SU 1,1\r\n'
    for dry in ("?dry_run=true", ""):
        answer = server.post(T + "/records" + dry, bad.encode(), headers=CSV)
        report = answer.json() if dry else answer.json()["rows"]
        assert answer.status == (200 if dry else 422), answer
        assert [(each["line"], each.get("column")) for each in report["problems"]] == [
            (3, "Depth"),
            (4, "Soil"),
            (6, "Period"),
            (7, None),
        ], report
        assert report["created"] == report["sequence"] == 0
    clash = server.post(T + "/records", b"code\nSU 10\nSU 20\nSU 10\n", headers=CSV).json()["rows"][
        "problems"
    ]
    assert [(each["line"], each["column"]) for each in clash] == [(4, "code")], clash
    many = "code;depth\n" + "".join(f"B {n};{n},5\n" for n in range(2000))
    dry = server.ok("POST", T + "/records?dry_run=true", many.encode(), headers=CSV).json()
    assert (dry["created"], dry["sequence"], dry["dry_run"]) == (2000, 0, True)
    with LiveClient(server, "south") as live:
        live.send({"op": "hello", "client": "test", "dpr": 1, "accept": ["jpeg"]})
        live.receive_until("welcome")
        made = server.ok(
            "POST", T + "/records", many.encode(), headers={**CSV, "Idempotency-Key": "many"}
        ).json()
        assert made["created"] == 2000
        told = live.receive_until("table", "record")
        assert (
            told["op"] == "table"
            and told["event"] == "changed"
            and told["table"]["records"] == 2003
        ), told
    assert (
        server.ok(
            "POST", T + "/records", many.encode(), headers={**CSV, "Idempotency-Key": "many"}
        ).json()
        == made
    )
    assert (
        server.ok("GET", T + "/records?sortby=-depth&limit=1").json()["records"][0]["values"][
            "depth"
        ]
        == 1999.5
    )
    server.ok("POST", T + "/undo")
    assert server.get(T).json()["records"] == 3


def test_a_map_brings_records(server):
    """Names in a map that the legend lacks become records with new keys."""
    server.ok("POST", "/tables/notes/records", {"values": {"name": "by hand"}})
    features = [
        {
            "type": "Feature",
            "properties": {"what": what},
            "geometry": {
                "type": "Polygon",
                "coordinates": [[[x, 10], [x + 20, 10], [x + 20, 30], [x, 30], [x, 10]]],
            },
        }
        for what, x in (("pit", 10), ("wall", 50))
    ]
    notes = "/models/north/layers/notes"
    server.ok(
        "POST",
        notes + "/polygons?attribute=what",
        {"type": "FeatureCollection", "features": features},
    )
    assert records(server, "/tables/notes") == {
        1: {"name": "by hand"},
        2: {"name": "pit"},
        3: {"name": "wall"},
    }
    assert area(server, 3, notes) > 0 and area(server, 1, notes) == 0
    assert (
        server.post(
            notes + "/polygons?value=77", {"type": "FeatureCollection", "features": features}
        ).status
        == 422
    )


def test_change_columns(server):
    before = records(server)
    etag = server.get(T).headers["ETag"]
    renamed = server.ok(
        "PATCH",
        T + "/columns/depth",
        {"name": "Depth below surface", "labels": {"es": "Profundidad"}},
        headers={"If-Match": etag},
    ).json()
    assert renamed["column"]["slug"] == "depth" and renamed["column"]["labels"] == {
        "es": "Profundidad"
    }
    assert (
        server.request(
            "PATCH", T + "/columns/depth", {"unit": "cm"}, headers={"If-Match": etag}
        ).status
        == 412
    )
    limit = server.request("PATCH", T + "/columns/depth", {"maximum": 0.1})
    assert limit.status == 409 and "Record 1" in limit.json()["detail"], limit
    server.ok("PATCH", T + "/columns/depth", {"maximum": 100})
    assert (
        "maximum"
        not in server.ok("PATCH", T + "/columns/depth", {"maximum": None}).json()["column"]
    )
    retyped = server.ok(
        "PATCH", T + "/columns/code", {"kind": "integer", "required": False, "unique": False}
    ).json()
    assert (retyped["converted"], retyped["lost"], retyped["lost_keys"]) == (
        0,
        3,
        [1, 2, 300],
    ), retyped
    server.ok("POST", T + "/undo")
    assert records(server) == before
    server.ok("DELETE", T + "/columns/dug")
    assert "dug" not in records(server)[1]
    server.ok("POST", T + "/undo")
    assert records(server) == before
    assert server.request("DELETE", "/tables/condition").json()["title"] == "Table in use"
    assert server.request("DELETE", T).status == 409


def test_change_at_once(server):
    """Three users change the names, columns and records of one table at the same time."""
    server.ok("POST", "/projects/default/tables", {"name": "Busy"})

    def rename(n):
        answer = server.request("PATCH", "/tables/busy", {"name": f"Busy {n}"})
        while answer.status == 412:  # another column was inserted in the meantime
            answer = server.request("PATCH", "/tables/busy", {"name": f"Busy {n}"})
        assert answer.status == 200, answer

    work = [
        rename,
        lambda n: server.ok("POST", "/tables/busy/columns", {"name": f"Column {n}"}),
        lambda n: server.ok("POST", "/tables/busy/records", {"values": {}}),
    ]
    with ThreadPoolExecutor(len(work)) as people:
        for done in [
            people.submit(lambda change=change: [change(n) for n in range(60)]) for change in work
        ]:
            done.result()
    table = server.get("/tables/busy").json()
    assert (table["name"], len(table["columns"]), table["records"]) == ("Busy 59", 60, 60), table


def test_circles(server):
    path = T + "/columns/above/cycles"
    assert server.ok("GET", path).json() == {"cycles": [], "total": 0}
    for key, above in ((1, [300]), (300, [2]), (2, [1])):
        server.ok("PATCH", f"{T}/records/{key}", {"values": {"above": above}})
    assert server.ok("GET", path).json()["cycles"] == [[1, 300, 2]]
    server.ok("POST", T + "/undo")
    assert server.ok("GET", path).json()["total"] == 0
    assert server.get(T + "/columns/condition/cycles").status == 422


def test_widen(server, cameras, story):
    """A layer without free keys gets a wider type. Its texels, history and undo remain."""
    camera = cameras["north"]
    path = "/models/north/layers/few"
    server.ok(
        "POST",
        "/models/north/layers",
        {
            "name": "Few",
            "kind": "database",
            "type": "u8",
            "resolution": 2048,
            "columns": [{"name": "Name"}],
        },
    )
    server.ok(
        "POST",
        "/tables/few/records",
        {"records": [{"key": key, "values": {}} for key in (1, 255, 70000)]},
    )

    def stroke(value, x, expect=200):
        body = {
            "op": "stroke",
            "value": value,
            "camera": camera,
            "radius_px": 30,
            "path": [[x, 240], [x + 20, 240]],
        }
        return server.ok("POST", path + "/edits", body, expect=(expect,)).json()

    def keys(query=""):
        return {
            each["key"]: each["texels"]
            for each in server.ok("GET", path + "/statistics" + query).json()["keys"]
        }

    stroke(1, 280)
    first = keys()
    then = server.get(path).json()["sequence"]
    stroke(255, 300)
    painted = keys()
    assert set(painted) == {1, 255} and painted[1] < first[1]
    refused = stroke(70000, 320, expect=422)
    assert "wider type" in refused["detail"], refused
    for body, field in (
        ({"type": "u8"}, "type"),
        ({"type": "f32"}, "type"),
        ({"type": "u32", "name": "Many"}, "type"),
        ({"type": "x"}, "type"),
    ):
        answer = server.request("PATCH", path, body)
        assert answer.status == 422 and answer.json()["field"] == field, (body, answer)
    before = server.ok("GET", path)
    wide = server.ok(
        "PATCH",
        path,
        {"type": "u32"},
        headers={"If-Match": before.headers["ETag"], "Idempotency-Key": "wide"},
    ).json()
    assert (wide["type"], wide["sequence"]) == ("u32", before.json()["sequence"]), wide
    assert (
        server.request(
            "PATCH", path, {"type": "u32"}, headers={"If-Match": before.headers["ETag"]}
        ).status
        == 412
    )
    assert keys() == painted and keys(f"?at={then}") == first
    stroke(70000, 320)
    assert set(keys()) == {1, 255, 70000}
    for expected in (painted, first):
        server.ok("POST", path + "/undo")
        assert keys() == expected, "what was painted before is undone after"
    server.ok("POST", path + "/redo")
    assert keys() == painted
    server.ok("POST", path + "/restore", {"sequence": then})
    assert keys() == first
    story.wide, story.painted = path, first


def test_refusals(server):
    for what, method, path, body, headers, status, field in [
        ("unknown table", "GET", "/tables/none", None, {}, 404, None),
        ("unknown project", "GET", "/projects/none/tables", None, {}, 404, None),
        ("unknown column", "DELETE", T + "/columns/none", None, {}, 404, None),
        ("unknown record", "GET", T + "/records/9", None, {}, 404, None),
        ("a key that is none", "GET", T + "/records/first", None, {}, 404, None),
        ("a numeric layer", "GET", "/models/north/layers/wet/records", None, {}, 422, "layer"),
        (
            "a table of a numeric layer",
            "POST",
            "/models/north/layers",
            {"name": "x", "table": "units"},
            {},
            422,
            "table",
        ),
        (
            "a table that is not there",
            "POST",
            "/models/north/layers",
            {"name": "x", "kind": "database", "table": "none"},
            {},
            422,
            "table",
        ),
        (
            "a table and columns",
            "POST",
            "/models/north/layers",
            {"name": "x", "kind": "database", "table": "units", "columns": []},
            {},
            422,
            "columns",
        ),
        (
            "a slug of digits",
            "POST",
            "/projects/default/tables",
            {"name": "x", "slug": "12"},
            {},
            422,
            "slug",
        ),
        (
            "a column of an unknown kind",
            "POST",
            T + "/columns",
            {"name": "x", "kind": "drawing"},
            {},
            422,
            "kind",
        ),
        (
            "a term of no table",
            "POST",
            T + "/columns",
            {"name": "x", "kind": "term"},
            {},
            422,
            "target",
        ),
        (
            "a required column on records that have none",
            "POST",
            T + "/columns",
            {"name": "x", "required": True},
            {},
            409,
            None,
        ),
        (
            "a slug that is taken",
            "POST",
            T + "/columns",
            {"name": "x", "slug": "code"},
            {},
            409,
            "slug",
        ),
        (
            "a value of another kind",
            "POST",
            T + "/records",
            {"values": {"code": "x", "depth": "deep"}},
            {},
            422,
            "values.depth",
        ),
        (
            "a value out of range",
            "POST",
            T + "/records",
            {"values": {"code": "x", "depth": -1}},
            {},
            422,
            "values.depth",
        ),
        (
            "no period",
            "POST",
            T + "/records",
            {"values": {"code": "x", "period": "circa 1560"}},
            {},
            422,
            "values.period",
        ),
        (
            "no choice",
            "POST",
            T + "/records",
            {"values": {"code": "x", "soil": "mud"}},
            {},
            422,
            "values.soil",
        ),
        (
            "no record of the target",
            "POST",
            T + "/records",
            {"values": {"code": "x", "condition": 99}},
            {},
            422,
            "values.condition",
        ),
        ("a value missing", "POST", T + "/records", {"values": {}}, {}, 422, "values.code"),
        (
            "a value twice",
            "POST",
            T + "/records",
            {"values": {"code": "SU 1"}},
            {},
            409,
            "values.code",
        ),
        (
            "SQL for a column",
            "POST",
            T + "/records",
            {"values": {'code"; DROP TABLE records.t1; --': 1}},
            {},
            422,
            None,
        ),
        (
            "SQL to sort by",
            "GET",
            T + "/records?sortby=key;DROP%20TABLE%20records.t1",
            None,
            {},
            422,
            "sortby",
        ),
        (
            "a column to sort by that is not there",
            "GET",
            T + "/records?sortby=none",
            None,
            {},
            422,
            "sortby",
        ),
        ("a moment that is none", "GET", T + "/records?at=yesterday", None, {}, 422, "at"),
        ("a future sequence", "GET", T + "/records?at=100000", None, {}, 422, "at"),
        ("an unknown format", "GET", T + "/records?f=ods", None, {}, 406, "f"),
        (
            "an unknown separator",
            "GET",
            T + "/records?f=csv&separator=pipe",
            None,
            {},
            422,
            "separator",
        ),
        (
            "one and several",
            "POST",
            T + "/records",
            {"key": 5, "records": [{}]},
            {},
            422,
            "records",
        ),
        ("an empty list", "POST", T + "/records", {"records": []}, {}, 422, "records"),
        (
            "a record twice in a list",
            "POST",
            T + "/records",
            {"records": [{"key": 5, "values": {"code": "a"}}, {"key": 5, "values": {"code": "b"}}]},
            {},
            422,
            "records[1].key",
        ),
        ("texels of no kind", "DELETE", T + "/records/1?texels=burn", None, {}, 422, "texels"),
        ("reassigned to nothing", "DELETE", T + "/records/1?texels=reassign", None, {}, 422, "to"),
        (
            "reassigned to itself",
            "DELETE",
            T + "/records/1?texels=reassign&to=1",
            None,
            {},
            422,
            "to",
        ),
        ("cleared to something", "DELETE", T + "/records/1?texels=clear&to=2", None, {}, 422, "to"),
        ("CSV of unknown columns", "POST", T + "/records", b"colour\nred\n", CSV, 422, "body"),
        ("CSV that is not UTF-8", "POST", T + "/records", b"code\n\xff\n", CSV, 422, "body"),
        ("empty CSV", "POST", T + "/records", b"", CSV, 422, "body"),
        ("CSV with an open quote", "POST", T + "/records", b'code\n"SU\n', CSV, 422, "body"),
        (
            "a dry run of JSON",
            "POST",
            T + "/records?dry_run=true",
            {"values": {}},
            {},
            422,
            "dry_run",
        ),
        ("nothing to redo", "POST", "/tables/samples/redo", None, {}, 409, None),
    ]:
        answer = server.request(method, path, body, headers=headers)
        assert answer.status == status, f"{what}: {answer}"
        assert field is None or answer.json().get("field") == field, f"{what}: {answer}"
    hostile = "Robert'); DROP TABLE records.t1; --\u202e \U0001f3fa"
    made = server.ok("POST", T + "/records", {"values": {"code": hostile}}).json()
    assert server.get(f"{T}/records/{made['key']}").json()["values"]["code"] == hostile
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": hostile, "columns": [{"name": hostile}, {"name": hostile}]},
    )
    server.ok("DELETE", f"{T}/records/{made['key']}")


def test_all_of_it_is_durable(server, story):
    content = records(server)
    assert server.stop() == 0
    server.start()
    assert records(server) == content
    assert {
        each["key"]: each["texels"]
        for each in server.ok("GET", story.wide + "/statistics").json()["keys"]
    } == story.painted


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
