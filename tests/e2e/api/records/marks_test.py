"""Lines and points of records on the surface, such as measured cracks and numbered samples.
The file tests them over HTTP, in frames, in tables, and on another version of the scan."""
import csv
import io
import math
import urllib.parse

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid
from support.pictures import pixels

M, T = "/models/sheet", "/tables/damage"  # a nearly flat sheet, x and y from 0 to 100 mm
L = M + "/layers/damage"
RED, BLUE = (220, 0, 0), (0, 0, 220)


def line(model, *places):
    return {"model": model, "coordinates": [list(place) for place in places]}


def near(a, b, by=1e-9):
    assert abs(a - b) <= by, (a, b)


def make(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    model = server.get(M).json()["id"]
    table = server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Damage",
            "columns": [
                {"name": "Code", "required": True, "unique": True},
                {"name": "Crack", "kind": "line"},
                {"name": "Sample", "kind": "point"},
            ],
        },
    ).json()
    assert [column["kind"] for column in table["columns"]] == ["text", "line", "point"], table
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Damage",
            "kind": "database",
            "type": "u16",
            "table": "damage",
            "resolution": 2048,
            "palette": {
                "mode": "categorical",
                "points": [{"at": 1, "color": "#dc0000"}, {"at": 2, "color": "#0000dc"}],
            },
        },
    )
    return model


@pytest.fixture(scope="module", autouse=True)
def model(server):
    return make(server)


@pytest.fixture
def camera(server):
    return camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))


def test_write(server, model):
    crack = [
        line(model, (20, 50, 0), (50, 50, 0), (50, 90, 0)),
        line(model, (10, 10, 0), (10, 20, 0)),
    ]
    made = server.ok("POST", T + "/records", {"values": {"code": "C 1", "crack": crack}}).json()
    assert made["values"]["crack"] == crack, made
    server.ok(
        "POST",
        T + "/records",
        {"values": {"code": "S 1", "sample": [line(model, (80, 20, 0)), line(model, (85, 20, 0))]}},
    )
    server.ok("POST", T + "/records", {"values": {"code": "Nothing", "crack": []}})
    for where in (T, L):
        records = {
            record["values"]["code"]: record
            for record in server.ok("GET", where + "/records").json()["records"]
        }
        near(records["C 1"]["length_m"], 0.080)
        assert (
            records["C 1"]["point_count"] == 0
            and records["S 1"]["point_count"] == 2
            and records["S 1"]["length_m"] == 0
        ), records
        assert records["Nothing"]["values"]["crack"] is None
        assert ("area_m2" in records["C 1"]) == (where == L)
        near(server.ok("GET", where + "/records/1").json()["length_m"], 0.080)
        order = {
            by: [
                record["key"]
                for record in server.ok("GET", f"{where}/records?sortby={by}").json()["records"]
            ]
            for by in ("-length_m", "point_count,-key", "-point_count")
        }
        assert order == {
            "-length_m": [1, 2, 3],
            "point_count,-key": [3, 1, 2],
            "-point_count": [2, 1, 3],
        }, order
        assert (
            server.ok("GET", where + "/records?sortby=-point_count&limit=1&offset=1").json()[
                "records"
            ][0]["key"]
            == 1
        )
    for crack, words in (
        ([line(99, (0, 0, 0), (1, 1, 1))], "model 99"),
        ("x", "list of lines"),
        ([line(model, (0, 0, 0))], "list of lines"),
        ([{"model": model}], None),
        ([line(model, (0, 0, 0), (0, 0, 0))], "list of lines"),
    ):
        refused = server.request("PATCH", T + "/records/1", {"values": {"crack": crack}})
        assert refused.status in (400, 422) and (
            words is None or words in refused.json()["detail"]
        ), (crack, refused)
    filtered = server.ok(
        "GET", T + "/records?filter=" + urllib.parse.quote("crack is not null")
    ).json()
    assert [record["key"] for record in filtered["records"]] == [1], filtered
    assert (
        server.get(T + "/records?filter=" + urllib.parse.quote("crack > 3")).json()["field"]
        == "filter"
    )


def test_tables(server):
    """Exports the data for spreadsheets and reports, and imports it."""
    text = server.ok("GET", T + "/records?f=csv").body.decode("utf-8-sig")
    rows = list(csv.DictReader(io.StringIO(text)))
    near(float(rows[0]["length_m"]), 0.080)
    assert (
        rows[1]["point_count"] == "2"
        and "LINESTRING Z (20 50 0, 50 50 0, 50 90 0)" in rows[0]["crack"]
    ), rows[0]
    report = server.ok(
        "POST", T + "/records", text.encode(), headers={"Content-Type": "text/csv"}
    ).json()
    assert (report["unchanged"], report["problems"]) == (3, []), report
    bad = server.ok(
        "POST",
        T + "/records?dry_run=true",
        b"key,crack\n1,1 LINESTRING Z (0 0 0)\n",
        headers={"Content-Type": "text/csv"},
    ).json()
    assert len(bad["problems"]) == 1 and "LINESTRING" in bad["problems"][0]["detail"], bad
    for path in (L, T):
        told = server.ok("GET", path + "/quantities").json()
        classes = {each["class"]: each for each in told["quantities"]}
        near(classes["C 1"]["length_m"], 0.080)
        assert (
            classes["S 1"]["point_count"] == 2
            and classes["S 1"]["area_m2"] == 0
            and set(classes) == {"C 1", "S 1"}
        ), told
        near(told["sum"]["length_m"], 0.080)
        sheet = list(
            csv.DictReader(
                io.StringIO(server.ok("GET", path + "/quantities?f=csv").body.decode("utf-8-sig"))
            )
        )
        assert sheet[-1]["class"] == "total" and sheet[-1]["point_count"] == "2", sheet
        near(float(sheet[-1]["length_m"]), 0.080)
    # the unit belongs to the model: lengths change with it, and no record is written again
    etag = server.get(M).headers["ETag"]
    etag = server.ok("PATCH", M, {"unit": "cm"}, headers={"If-Match": etag}).headers["ETag"]
    near(server.ok("GET", T + "/records/1").json()["length_m"], 0.80)
    server.ok("PATCH", M, {"unit": "mm"}, headers={"If-Match": etag})


def test_extents(server):
    """The extent of records that have lines and points but no texels."""
    extent = server.ok("POST", L + "/extent", {"keys": [1]}).json()
    assert (extent["records"], extent["painted"], extent["marked"], extent["area_m2"]) == (
        1,
        0,
        1,
        0,
    ), extent
    assert extent["bounds"] == {"min": [10, 10, 0], "max": [50, 90, 0]}, extent
    both = server.ok(
        "POST", L + "/extent", {"filter": "crack is not null or sample is not null"}
    ).json()
    assert (both["records"], both["marked"]) == (2, 2) and both["bounds"] == {
        "min": [10, 10, 0],
        "max": [85, 90, 0],
    }, both
    nowhere = server.ok("POST", L + "/extent", {"keys": [3]}).json()
    assert (nowhere["records"], nowhere["marked"]) == (1, 0) and "bounds" not in nowhere, nowhere
    # the extent together with texels
    server.ok(
        "POST",
        L + "/readings?radius_mm=2",
        "x,y,z,value\n95,5,0,1\n",
        headers={"Content-Type": "text/csv"},
    )
    painted = server.ok("POST", L + "/extent", {"keys": [1]}).json()
    assert (
        painted["painted"] == painted["marked"] == 1
        and painted["bounds"]["max"][0] > 94
        and painted["bounds"]["min"][0] == 10
    ), painted
    server.ok("POST", L + "/undo")


def count(rows, color):
    return sum(all(abs(a - b) <= 30 for a, b in zip(pixel, color)) for row in rows for pixel in row)


def test_pictures(server, camera):
    def shown(**more):
        rows = pixels(
            server.ok(
                "POST",
                M + "/frame",
                {"camera": camera, "light": {"mode": "unlit"}, "format": "png", **more},
            ).body
        )
        return count(rows, RED), count(rows, BLUE)

    red, blue = shown()
    assert red > 400 and 100 < blue < red, (red, blue)
    assert shown(layers=[]) == (0, 0), "they come and go with the layer"
    server.ok("PATCH", L, {"visible": False})
    assert shown() == (0, 0)
    server.ok("PATCH", L, {"visible": True})
    from_below = camera_from(server.get(M).json(), (0, 0, -1), up=(0, 1, 0))
    behind = pixels(
        server.ok(
            "POST",
            M + "/frame",
            {"camera": from_below, "light": {"mode": "unlit"}, "format": "png"},
        ).body
    )
    assert count(behind, RED) > 0, "the sheet is thin: both sides show what lies on it"


def test_live(server, model):
    """Participants at the model receive a line that another user writes."""
    with LiveClient(server, "sheet") as viewer:
        viewer.hello(dpr=1, accept=["jpeg"])
        server.ok(
            "PATCH",
            T + "/records/3",
            {"values": {"crack": [line(model, (60, 60, 0), (90, 60, 0))]}},
        )
        told = viewer.receive_until("record")
        assert told["key"] == 3 and told["record"]["values"]["crack"][0]["model"] == model, told
    server.ok("POST", T + "/undo")


def test_history(server):
    before = server.ok("GET", T + "/records/1").json()
    sequence = int(server.get(T + "/records").headers["Strata-Sequence"])
    server.ok("PATCH", T + "/records/1", {"values": {"crack": None}})
    assert server.ok("GET", T + "/records/1").json()["length_m"] == 0
    near(server.ok("GET", f"{T}/records/1?at={sequence}").json()["length_m"], 0.080)
    server.ok("POST", T + "/undo")
    assert server.ok("GET", T + "/records/1").json()["values"] == before["values"]
    text = server.ok("PATCH", T + "/columns/crack", {"kind": "text"})
    assert text.status == 200
    assert "LINESTRING" in server.ok("GET", T + "/records/1").json()["values"]["crack"]
    server.ok("POST", T + "/undo")
    near(server.ok("GET", T + "/records/1").json()["length_m"], 0.080)


def test_past_pictures(server, camera):
    """A frame of an earlier time shows the lines of that time."""

    def dab(x):
        return server.ok(
            "POST",
            L + "/readings?radius_mm=2",
            f"x,y,z,value\n{x},95,0,3\n",
            headers={"Content-Type": "text/csv"},
        ).json()["sequence"]

    def shown(**more):
        asked = {"camera": camera, "light": {"mode": "unlit"}, "format": "png", **more}
        return count(pixels(server.ok("POST", M + "/frame", asked).body), RED)

    before, first = shown(), dab(5)
    assert before > 400, before
    server.ok("PATCH", T + "/records/1", {"values": {"crack": None}})
    second = dab(95)
    assert shown() == shown(at=second) == 0 and shown(at=first) == before, (
        shown(),
        shown(at=second),
        shown(at=first),
        before,
    )
    server.ok("POST", T + "/undo")
    for _ in range(2):
        server.ok("POST", L + "/undo")
    assert shown() == before


def test_transfer(server):
    """The second scan contains half of the wall. Lines and points on that half are transferred and
    snapped to its surface."""
    half = folded_grid(size=60.0, fold=0.001)
    server.import_model(half, "half.ply", name="Half", unit="mm")
    other = server.get("/models/half").json()["id"]
    wish = {"from": "sheet", "tolerance_mm": 1}
    report = server.wait_for_job(server.ok("POST", "/models/half/transfer", wish).json()["id"])[
        "report"
    ]
    assert report["marks"] >= 2 and report["lost_marks"] >= 1, report
    record = server.ok("GET", T + "/records/1").json()
    there = [mark for mark in record["values"]["crack"] if mark["model"] == other]
    assert [[round(number) for number in place[:2]] for place in there[0]["coordinates"]] == [
        [20, 50],
        [50, 50],
    ], record
    on_half = {
        each["key"]: each
        for each in server.ok("GET", "/models/half/layers/damage/records").json()["records"]
    }
    near(on_half[1]["length_m"], 0.040, 1e-5)
    near(server.ok("GET", T + "/records/1").json()["length_m"], 0.120, 1e-5)
    again = server.wait_for_job(server.ok("POST", "/models/half/transfer", wish).json()["id"])[
        "report"
    ]
    assert again["marks"] == 0, "what is there stays as it is"
    server.ok("POST", T + "/undo")
    near(server.ok("GET", T + "/records/1").json()["length_m"], 0.080)
    server.ok("DELETE", "/models/half")
    # restores lines on a deleted model, which are not counted and have no other effect
    server.ok("POST", T + "/redo")
    near(server.ok("GET", T + "/records/1").json()["length_m"], 0.080)
    server.ok("PATCH", T + "/records/1", {"values": {"code": "C one"}})
    assert math.isclose(server.ok("GET", L + "/records/1").json()["length_m"], 0.080)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
