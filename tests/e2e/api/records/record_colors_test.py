"""Records on the surface: colors by a column, highlighted records, their extents, over HTTP and in
a live view."""
import math
import urllib.parse

import pytest
from support.cameras import camera_from
from support.live_client import LAST_RECTANGLE, LiveClient
from support.meshes import folded_grid
from support.pictures import pixels
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
L = M + "/layers/pieces"
UNLIT = {"mode": "unlit"}
RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)
PLACES = {1: (30, 30), 2: (70, 30), 3: (70, 70), 4: (30, 70)}


def color_at(rows, key):
    """Returns the color at the record's point. The camera is perpendicular to the sheet of 100 mm
    and shows 110 % of its diagonal, from every side. The scale comes from the outermost painted
    pixels."""
    x, y = PLACES[key]
    height, width = len(rows), len(rows[0])
    return rows[round((0.5 - (y - 50) / 100 * SCALE) * height)][
        round(width / 2 + (x - 50) / 100 * SCALE * height)
    ]


SCALE = None


def find_scale(server, camera):
    """Returns the sheet's side relative to the frame's height, from the width of the surface in the
    middle row."""
    rows = pixels(
        server.ok(
            "POST", M + "/frame", {"camera": camera, "layers": [], "light": UNLIT, "format": "png"}
        ).body
    )
    top = rows[0][0]
    middle = rows[len(rows) // 2]
    differs = [
        x
        for x, pixel in enumerate(middle)
        if sum(abs(a - b) for a, b in zip(pixel, rows[len(rows) // 2][0])) > 12
    ]
    assert differs, top
    return (differs[-1] - differs[0] + 1) / len(rows)


def near(a, b, by=3):
    return all(abs(x - y) <= by for x, y in zip(a, b))


def colors(server, camera, **more):
    rows = pixels(
        server.ok(
            "POST", M + "/frame", {"camera": camera, "light": UNLIT, "format": "png", **more}
        ).body
    )
    return {key: color_at(rows, key) for key in PLACES}


def set_palette(server, palette):
    return server.ok("PATCH", L, {"palette": palette}).json()["palette"]


def point(value, color, at, **more):
    return {"at": at, "value": value, "color": color, **more}


BY_STATE = {
    "mode": "categorical",
    "column": "state",
    "points": [point("loose", "#ff0000", 0), point("firm", "#00ff00", 1)],
    "others": "#0000ff",
}


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    columns = [
        {"name": "Name"},
        {"name": "Thickness", "kind": "numeric", "unit": "mm"},
        {"name": "State", "kind": "enumeration", "choices": ["loose", "firm"]},
    ]
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Pieces",
            "kind": "database",
            "type": "u16",
            "resolution": 2048,
            "columns": columns,
        },
    )
    server.ok(
        "POST",
        "/tables/pieces/columns",
        {"name": "Above", "kind": "relation", "target": "pieces"},
    )
    server.ok("POST", M + "/layers", {"name": "Wet", "type": "f32", "resolution": 2048})
    for values in (
        {"thickness": 4, "state": "loose"},
        {"thickness": 8, "state": "firm"},
        {"thickness": 2, "state": "loose"},
        {"name": "Unknown"},
        {"name": "Lost"},
    ):
        server.ok("POST", "/tables/pieces/records", {"values": values})
    for key, (x, y) in PLACES.items():
        dab(server, L, key, x, y, 10)
    return server


@pytest.fixture(scope="module", autouse=True)
def camera(server):
    global SCALE
    camera = camera_from(server.get(M).json(), [0, 0, 1], up=(0, 1, 0))
    SCALE = find_scale(server, camera)
    return camera


def test_classes(server):
    def classes(column, **query):
        answer = server.ok(
            "GET", f"/tables/pieces/columns/{column}/classes?" + urllib.parse.urlencode(query)
        ).json()
        assert answer["total"] == len(answer["classes"])
        return answer

    states = classes("state")
    assert states["classes"] == [
        {"value": "loose", "records": 2},
        {"value": "firm", "records": 1},
    ], states
    assert (states["records"], states["without"], states["unclassified"]) == (5, 2, 0), states
    assert classes("state", count=1)["unclassified"] == 1
    equal = classes("thickness", method="equal", count=2)
    assert equal["classes"] == [
        {"from": 2, "to": 5, "records": 2},
        {"from": 5, "to": 8, "records": 1},
    ], equal
    quantile = classes("thickness", method="quantile", count=3)
    assert [each["records"] for each in quantile["classes"]] == [1, 1, 1], quantile
    assert {each["value"] for each in classes("thickness")["classes"]} == {"2", "4", "8"}
    for column, query, field in (
        ("state", {"method": "equal"}, "method"),
        ("state", {"method": "jenks"}, "method"),
        ("state", {"count": 0}, "count"),
        ("above", {}, "column"),
    ):
        answer = server.get(
            f"/tables/pieces/columns/{column}/classes?" + urllib.parse.urlencode(query)
        )
        assert answer.status == 422 and answer.json()["field"] == field, answer
    assert server.get("/tables/pieces/columns/none/classes").status == 404


def test_columns(server, camera):
    bare = colors(server, camera, layers=[])
    assert set_palette(server, BY_STATE)["others"] == "#0000ffff"
    shown = colors(server, camera)
    assert [shown[key] for key in (1, 2, 3, 4)] == [RED, GREEN, RED, BLUE], shown
    # numbers as classes and as a gradient; records without a value are gray and half transparent
    set_palette(
        server,
        {
            "mode": "step",
            "column": "thickness",
            "points": [{"at": 0, "color": "#ff0000"}, {"at": 5, "color": "#00ff00"}],
        },
    )
    shown = colors(server, camera)
    assert [shown[key] for key in (1, 2, 3)] == [RED, GREEN, RED], shown
    assert near(shown[4], [(154 + each) / 2 for each in bare[4]], 4), (shown, bare)
    set_palette(
        server,
        {
            "mode": "linear",
            "column": "thickness",
            "points": [{"at": 0, "color": "#000000"}, {"at": 8, "color": "#ffffff"}],
        },
    )
    shown = colors(server, camera)
    assert (
        near(shown[1], (128, 128, 128))
        and shown[2] == (255, 255, 255)
        and near(shown[3], (64, 64, 64))
    ), shown
    # a change to a record changes the frame, and a dropped column is reported
    set_palette(server, BY_STATE)
    server.ok("PATCH", "/tables/pieces/records/2", {"values": {"state": "loose"}})
    assert colors(server, camera)[2] == RED
    server.ok("POST", "/tables/pieces/undo")
    assert colors(server, camera)[2] == GREEN
    for palette, field in (
        (
            {"mode": "linear", "column": "state", "points": [{"at": 0, "color": "#000000"}]},
            "palette.column",
        ),
        ({"mode": "categorical", "column": "nothing"}, "palette.column"),
        ({"mode": "categorical", "column": "above"}, "palette.column"),
    ):
        set_palette(server, palette)
        answer = server.post(M + "/frame", {"camera": camera})
        assert answer.status == 422 and answer.json()["field"] == field, (palette, answer)
    for bad, field in (
        ({"pattern": "stripes"}, "pattern"),
        ({"angle": 200}, "angle"),
        ({"spacing_mm": -1}, "spacing_mm"),
    ):
        answer = server.request(
            "PATCH",
            L,
            {"palette": {"mode": "categorical", "points": [{"at": 1, "color": "#000000", **bad}]}},
        )
        assert answer.status == 422 and answer.json()["field"] == f"palette.points[0].{field}", (
            bad,
            answer,
        )
    answer = server.request(
        "PATCH",
        L,
        {
            "palette": {
                "mode": "linear",
                "points": [{"at": 1, "color": "#000000", "pattern": "dots"}],
            }
        },
    )
    assert answer.status == 422 and "patterns" in answer.json()["detail"], answer
    kept = set_palette(
        server,
        {
            "mode": "categorical",
            "points": [
                {"at": 1, "color": "#ff0000", "pattern": "hatch", "spacing_mm": 2.5},
                {"at": 2, "color": "#00ff00"},
            ],
        },
    )
    assert (
        kept["points"][0]["pattern"] == "hatch"
        and kept["points"][0]["angle"] == 45
        and kept["points"][0]["spacing_mm"] == 2.5
    ), kept
    assert "pattern" not in kept["points"][1], kept


def test_highlight(server, camera):
    set_palette(server, BY_STATE)
    bare = colors(server, camera, layers=[])

    def shown(**highlight):
        return colors(server, camera, highlights=[{"layer": "pieces", "highlight": highlight}])

    dimmed = {
        key: tuple((128 * 72 + each * (255 - 72)) / 255 for each in bare[key]) for key in PLACES
    }
    lit = shown(filter="state = 'loose'")
    assert (
        lit[1] == RED and lit[3] == RED and near(lit[2], dimmed[2]) and near(lit[4], dimmed[4])
    ), (lit, dimmed)
    lit = shown(keys=[2, 4], isolate=True)
    assert (
        lit[2] == GREEN and lit[4] == BLUE and near(lit[1], bare[1], 1) and near(lit[3], bare[3], 1)
    ), (lit, bare)
    assert shown(keys=[])[1] != RED, "nothing is meant: nothing stands out"
    for highlight, field in (
        ({"filter": "state = "}, "highlights[0].highlight.filter"),
        ({"filter": "nothing > 1"}, "highlight.filter"),
    ):
        answer = server.post(
            M + "/frame",
            {"camera": camera, "highlights": [{"layer": "pieces", "highlight": highlight}]},
        )
        assert (
            answer.status == 422 and answer.json()["field"] == field and "offset" in answer.json()
        ), answer
    for highlight in ({}, {"keys": [1], "filter": "true"}, {"keys": [-1]}, {"keys": "1"}):
        assert (
            server.post(
                M + "/frame",
                {"camera": camera, "highlights": [{"layer": "pieces", "highlight": highlight}]},
            ).status
            == 422
        ), highlight
    answer = server.post(
        M + "/frame",
        {"camera": camera, "highlights": [{"layer": "wet", "highlight": {"keys": [1]}}]},
    )
    assert answer.status == 422 and "stores numbers" in answer.json()["detail"], answer

    extent = server.ok("POST", L + "/extent", {"filter": "state = 'loose' or state is null"}).json()
    assert (extent["records"], extent["painted"]) == (4, 3), extent  # record 5 is not painted
    assert abs(extent["area_m2"] / (3 * math.pi * 1e-4) - 1) < 0.02, extent
    low, high = extent["bounds"]["min"], extent["bounds"]["max"]
    assert near(low[:2], (20, 20), 0.2) and near(high[:2], (80, 80), 0.2), extent
    alone = server.ok("POST", L + "/extent", {"keys": [2]}).json()
    assert near(alone["bounds"]["max"][:2], (80, 40), 0.2) and alone["painted"] == 1, alone
    assert server.ok("POST", L + "/extent", {"keys": [77]}).json() == {
        "records": 1,
        "painted": 0,
        "marked": 0,
        "texels": 0,
        "area_m2": 0,
    }
    assert server.post(L + "/extent", {"filter": "thick > 1"}).json()["field"] == "filter"
    assert server.post(M + "/layers/wet/extent", {"keys": [1]}).status == 422


def test_live(server, camera):
    """A user's highlighted records are private, and follow changes to the records. (The page's test
    checks the colors.)"""
    set_palette(server, BY_STATE)
    with LiveClient(server, "sheet") as live, LiveClient(server, "sheet") as other:
        for each in (live, other):
            each.hello()
            each.send({"op": "layers", "light": UNLIT, "layers": []})
            each.send({"op": "camera", "seq": 1, **camera})

        def next_picture(before, each=live):
            """Returns the next different frame. After a pause the server sends the whole frame or
            only the changed part."""
            while True:
                frame = each.receive_until("frame")
                if frame["payload"] != before and frame["flags"] & LAST_RECTANGLE:
                    return frame["payload"]

        def highlight(**what):
            live.send(
                {"op": "layers", "light": UNLIT, "layers": [{"layer": "pieces", "highlight": what}]}
            )

        colored = next_picture(None)
        next_picture(None, other)
        highlight(filter="thickness >= 4", isolate=True)
        isolated = next_picture(colored)
        # another user changes a value, so the third record also matches
        server.ok("PATCH", "/tables/pieces/records/3", {"values": {"thickness": 9}})
        assert next_picture(isolated) != colored
        # records that cannot be highlighted are reported, and the connection stays open
        highlight(filter="nothing = 1")
        problem = live.receive_until("problem")
        assert (problem["status"], problem["field"], problem["offset"]) == (
            422,
            "highlight.filter",
            0,
        ), problem
        for message, field in (
            ({"layer": "wet", "highlight": {"keys": [1]}}, "layers[0].highlight"),
            ({"layer": "pieces", "highlight": {"filter": "state ="}}, "layers[0].highlight.filter"),
        ):
            live.send({"op": "layers", "layers": [message]})
            assert live.receive_until("problem")["field"] == field
        # a personal palette with another column
        mine = {
            "mode": "linear",
            "column": "thickness",
            "points": [{"at": 0, "color": "#000000"}, {"at": 9, "color": "#ffffff"}],
        }
        live.send(
            {"op": "layers", "light": UNLIT, "layers": [{"layer": "pieces", "palette": mine}]}
        )
        assert next_picture(isolated)
        # the other user saw no effect of this, but the shared colors change with the records
        server.ok("PATCH", "/tables/pieces/records/3", {"values": {"state": "firm"}})
        assert next_picture(None, other)
    server.ok("PATCH", "/tables/pieces/records/3", {"values": {"thickness": 2, "state": "loose"}})


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
