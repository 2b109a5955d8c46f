"""Records in queries, over HTTP: filters of tables, columns in conditions, and layers that are
computed from other layers, from records and from the surface."""
import base64
import math
import urllib.parse

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import pixels
from support.readings import dab
from support.strata_server import wait_for

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), (a, b)


def select(server, where, **more):
    return server.ok("POST", M + "/select", {"where": where, **more}).json()["area_m2"]


def value(server, layer, x, y):
    point = urllib.parse.urlencode({"coords": f"POINT Z({x} {y} 0)", "parameter-name": layer})
    return server.get(f"{M}/position?{point}").json()["values"][layer]


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    columns = [
        {"name": "Name"},
        {"name": "Thickness", "kind": "numeric", "unit": "mm"},
        {"name": "State", "kind": "enumeration", "choices": ["loose", "firm"]},
        {"name": "Period", "kind": "period"},
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
    server.ok("POST", M + "/layers", {"name": "Wet", "type": "f32", "resolution": 2048})
    for values in (
        {"name": "Head", "thickness": 4, "state": "loose", "period": "1560~"},
        {"name": "Foot", "thickness": 8, "state": "firm"},
        {"name": "Hand", "thickness": 2, "period": "1700/.."},
    ):
        server.ok("POST", "/tables/pieces/records", {"values": values})
    dab(server, f"{M}/layers/pieces", 1, 30, 30, 10)
    dab(server, f"{M}/layers/pieces", 2, 70, 30, 6)
    dab(server, f"{M}/layers/pieces", 3, 70, 70, 6)
    dab(server, f"{M}/layers/wet", 0.75, 35, 30, 20)
    dab(server, f"{M}/layers/wet", 0.25, 25, 22, 20)
    dab(server, f"{M}/layers/wet", 0.75, 30, 30, 5)
    return server


def fill_wet(server, value):
    server.ok(
        "POST",
        M + "/layers/wet/edits",
        {"op": "fill", "mode": "where", "where": "valid(wet)", "value": value},
    )


def test_filters(server):
    def keys(text, path="/tables/pieces", **more):
        query = urllib.parse.urlencode({"filter": text, **more})
        answer = server.ok("GET", f"{path}/records?{query}").json()
        return [each["key"] for each in answer["records"]], answer["total"]

    assert keys("thickness > 3 and state like 'l%'") == ([1], 1)
    assert keys("thickness is not null", sortby="-thickness", limit=1) == ([2], 3)
    assert keys("t_before(period, '1600') or casei(name) = 'hand'", path=M + "/layers/pieces") == (
        [1, 3],
        2,
    )
    csv = server.ok(
        "GET", "/tables/pieces/records?f=csv&" + urllib.parse.urlencode({"filter": "thickness < 5"})
    ).body.decode("utf-8-sig")
    assert len(csv.strip().split("\r\n")) == 3, csv
    for text, offset, says in (
        ("thick > 3", 0, "no column 'thick'"),
        ("thickness > ", 12, "the end"),
        ("state = 'lose'", 8, "not a choice"),
        ("name = 'ä' and thickness = 'x'", 15, "holds numbers"),
        ("1=1; drop table records.t1", 3, "no meaning"),
    ):
        answer = server.get("/tables/pieces/records?" + urllib.parse.urlencode({"filter": text}))
        problem = answer.json()
        assert (
            answer.status == 422
            and problem["field"] == "filter"
            and problem["offset"] == offset
            and says in problem["detail"]
        ), problem


def test_conditions(server):
    fill_wet(server, 0.25)
    dab(server, f"{M}/layers/wet", 0.75, 30, 30, 5)
    near(select(server, "pieces.thickness > 3"), (100 + 36) * math.pi * 1e-6, 0.03)
    near(select(server, "pieces.state = 'loose' and wet > 0.5"), 25 * math.pi * 1e-6, 0.03)
    near(select(server, "x < 50 and y < 50 and z < 1"), 2500e-6, 0.01)
    near(select(server, "valid(x) and x < 50"), 5000e-6, 0.01)
    answer = server.post(M + "/select", {"where": "wet > 0 and pieces.thick > 1"})
    assert (
        answer.status == 422 and answer.json()["offset"] == 12 and answer.json()["field"] == "where"
    ), answer
    answer = server.post(M + "/select", {"where": "slope > 3"})
    assert answer.status == 422 and "computed layers" in answer.json()["detail"], answer
    assert answer.json()["reason"] == "computed_layers_only"


def test_mistakes_are_corrected(server):
    for text, reason, suggestions in (
        ("wte > 0", "unknown_layer", ["wet"]),
        ("wet > 0 and peices.thickness > 1", "unknown_layer", ["pieces.thickness"]),
        ("wet > 0 and pieces.thikness > 1", "unknown_column", ["pieces.thickness"]),
        ("pieces.state = 'lose'", "unknown_choice", ["'loose'"]),
        ("vaild(wet)", "unknown_function", ["valid"]),
        ("wet > 3 mm", "unit", ["3"]),
        ("wet", "expects_condition", None),
    ):
        problem = server.post(M + "/select", {"where": text}).json()
        assert problem["status"] == 422 and problem["reason"] == reason, problem
        assert problem.get("suggestions") == suggestions, problem
        if suggestions is None:
            continue
        assert "Did you mean " + suggestions[0] in problem["detail"], problem
        begin, length = problem["offset"], problem["length"]
        corrected = text[:begin] + suggestions[0] + text[begin + length :]
        server.ok("POST", M + "/select", {"where": corrected})


def compute(server, name, expression, expect=201, **more):
    return server.ok(
        "POST",
        M + "/layers",
        {"name": name, "expression": expression, "resolution": 2048, **more},
        expect=(expect,),
    ).json()


def test_computing(server):
    fill_wet(server, 0.75)
    risk = compute(server, "Risk", "if(pieces.state = 'loose', 10, 1) * wet")
    assert (
        risk["expression"].startswith("if(")
        and risk["type"] == "f32"
        and risk["locked"]
        and not risk["visible"]
    ), risk
    assert (risk["inputs"], risk["stale"], risk["recompute"]) == (
        ["pieces", "wet"],
        False,
        "manual",
    ), risk
    assert value(server, "risk", 30, 30) == {"valid": True, "value": 7.5}
    assert value(server, "risk", 90, 10)["valid"] is False
    assert server.get(M + "/layers/risk/edits").json()["edits"][0]["op"] == "compute"

    # after a change to a record or to texels, the layer is stale until it is computed again
    server.ok("PATCH", "/tables/pieces/records/1", {"values": {"state": "firm"}})
    assert server.get(M + "/layers/risk").json()["stale"] is True
    assert value(server, "risk", 30, 30)["value"] == 7.5
    assert server.ok("POST", M + "/layers/risk/compute").json()["stale"] is False
    assert value(server, "risk", 30, 30)["value"] == 0.75
    dab(server, f"{M}/layers/wet", 0.25, 30, 30, 2)
    assert {
        each["slug"]: each.get("stale") for each in server.get(M + "/layers").json()["layers"]
    } == {"pieces": None, "wet": None, "risk": True}
    server.ok("POST", M + "/layers/risk/compute")
    assert (
        value(server, "risk", 30, 30)["value"] == 0.25
        and server.get(M + "/layers/risk").json()["stale"] is False
    )

    # conditions, types, and the surface
    mask = compute(server, "Mask", "risk > 0.5", type="u8")
    assert mask["inputs"] == ["risk"] and value(server, "mask", 30, 38) == {
        "valid": True,
        "value": 1,
    }
    assert not value(server, "mask", 30, 30)["valid"] and not value(server, "mask", 90, 10)["valid"]
    compute(server, "Rounded", "x / 10", type="u8")
    assert (
        value(server, "rounded", 47, 50)["value"] == 5
        and value(server, "rounded", 44, 50)["value"] == 4
    )
    total = server.get(M).json()["area_m2"]
    texel = compute(server, "Texel", "area")
    statistics = server.get(f"{M}/layers/{texel['slug']}/statistics").json()
    near(statistics["mean"] * statistics["texels"], total, 0.05)
    job = compute(server, "Steep", "if(slope < 45 and nz > 0.7, height, 0)", expect=202)
    done = server.wait_for_job(job["id"])
    assert done["state"] == "done" and len(done["layers"]) == 1, done
    near(server.get(M + "/layers/steep/statistics").json()["area_m2"], total, 0.001)

    # only the expression can change a computed layer
    for method, path, body in (
        ("POST", "edits", {"op": "fill", "value": 1, "mode": "where", "where": "true"}),
        ("POST", "undo", None),
    ):
        answer = server.request(method, f"{M}/layers/risk/{path}", body)
        assert answer.status == 403 and answer.json()["title"] == "Layer is locked", answer

    # cycles, and expressions with unknown names
    for name, body in (
        ("risk", {"expression": "mask + 1"}),
        ("risk", {"expression": "risk + 1"}),
        ("mask", {"expression": "salt > 1"}),
        ("mask", {"expression": "risk >"}),
        ("mask", {"expression": "pieces.thick"}),
        ("pieces", {"expression": "1"}),
        ("wet", {"recompute": "automatic"}),
    ):
        answer = server.request("PATCH", f"{M}/layers/{name}", body)
        assert answer.status == 422 and answer.json()["field"] in ("expression", "recompute"), (
            body,
            answer,
        )
    before = server.get(M + "/layers").json()["total"]
    for body, field in (
        ({"expression": "wet + "}, "expression"),
        ({"expression": "x * 100", "type": "u8"}, "type"),
        ({"expression": "wet", "compute": {"kind": "slope"}}, "expression"),
        ({"expression": "wet", "kind": "database"}, "kind"),
        ({"recompute": "automatic"}, "recompute"),
    ):
        answer = server.post(M + "/layers", {"name": "Bad", "resolution": 2048, **body})
        assert answer.status == 422 and answer.json()["field"] == field, (body, answer)
    assert (
        server.get(M + "/layers").json()["total"] == before
    ), "nothing is left of a layer that cannot be computed"


def compute_along(server, name, expression, **more):
    """Creates a layer with functions along the surface, in a job."""
    job = compute(server, name, expression, expect=202, **more)
    done = server.wait_for_job(job["id"])
    assert done["state"] == "done", done
    return server.get(f"{M}/layers/{done['layers'][0]}").json()


def test_distances_along_the_surface(server):
    """The sheet is nearly flat, so distances are those of the plane."""
    server.ok("POST", M + "/layers", {"name": "Marks", "type": "u8", "resolution": 2048})
    dab(server, f"{M}/layers/marks", 1, 20, 50, 10)
    dab(server, f"{M}/layers/marks", 3, 80, 50, 10)

    away = compute_along(server, "Away", "distance(marks = 1)")
    assert away["inputs"] == ["marks"] and away["stale"] is False, away
    for x, y in ((50, 50), (20, 95), (90, 90), (70, 20)):
        near(value(server, "away", x, y)["value"], math.hypot(x - 20, y - 50) - 10, 0.01)
    assert value(server, "away", 20, 50)["value"] == 0

    # up to a limit, as a buffer, and in the middle of an expression
    compute_along(server, "Limited", "distance(marks, 15)")
    near(value(server, "limited", 42, 50)["value"], 12, 0.01)
    assert not value(server, "limited", 50, 50)["valid"]
    buffer = compute_along(server, "Buffer", "within(marks = 3, 5)", type="u8")
    assert buffer["type"] == "u8" and value(server, "buffer", 80, 63)["value"] == 1
    area = server.get(M + "/layers/buffer/statistics").json()["area_m2"]
    near(area, 15 * 15 * math.pi * 1e-6, 0.02)
    compute_along(server, "Sum", "2 * distance(marks = 1) + if(within(marks = 3, 5), 100, 0)")
    near(value(server, "sum", 50, 50)["value"], 40, 0.01)
    near(value(server, "sum", 80, 50)["value"], 200, 0.01)
    compute_along(server, "Nested", "distance(distance(marks = 1) < 5)")
    near(value(server, "nested", 60, 50)["value"], 25, 0.01)
    compute_along(server, "Flat", "distance(slope < 45 and x > 90)")
    near(value(server, "flat", 40, 50)["value"], 50, 0.01)

    # each place has the value of the nearest mark
    halves = compute_along(server, "Halves", "nearest(marks)", type="u8")
    assert halves["type"] == "u8"
    for x, y, mark in ((5, 5, 1), (47, 90, 1), (53, 10, 3), (95, 95, 3)):
        assert value(server, "halves", x, y) == {"valid": True, "value": mark}
    total = server.get(M).json()["area_m2"]
    near(select(server, "halves = 1"), total / 2, 0.02)
    compute_along(server, "Reach", "nearest(pieces, 3)")
    assert value(server, "reach", 30, 42)["value"] == 1
    assert not value(server, "reach", 30, 45)["valid"]

    # after a dab, the layer is stale until it is computed again
    dab(server, f"{M}/layers/marks", 1, 60, 90, 4)
    assert server.get(M + "/layers/away").json()["stale"] is True
    assert server.ok("POST", M + "/layers/away/compute").json()["stale"] is False
    near(value(server, "away", 60, 70)["value"], 16, 0.01)
    assert value(server, "away", 60, 90)["value"] == 0


def test_neighborhoods(server):
    """Values within a radius along the surface, on two bands at x = 50."""
    expression = "case when x < 50 then 10 when y < 80 then 20 end"
    compute(server, "Bands", expression)
    # The radius has 10 texels.
    compute_along(server, "Mean", "focal_mean(bands, 0.5)")
    for x, right in ((20, 10), (50, 15), (80, 20)):
        near(value(server, "mean", x, 50)["value"], right, 0.05)
    # The part of a disc beyond a line at half of its radius is 0.1955.
    near(value(server, "mean", 49.75, 50)["value"], 11.955, 0.05)
    assert not value(server, "mean", 80, 81)["valid"]
    near(value(server, "mean", 80, 80.3)["value"], 20, 0.001)
    compute_along(server, "Relief", "focal_max(bands, 0.5) - focal_min(bands, 0.5)")
    assert value(server, "relief", 49.7, 50)["value"] == 10
    assert value(server, "relief", 49, 50)["value"] == 0
    compute_along(server, "Variety", "focal_variety(bands, 0.5)", type="u8")
    assert value(server, "variety", 50.3, 50)["value"] == 2
    assert value(server, "variety", 60, 50)["value"] == 1
    compute_along(server, "Spots", "hot_spot(bands, 0.5)")
    low, high = value(server, "spots", 20, 50)["value"], value(server, "spots", 80, 40)["value"]
    assert low < -0.5 and high > 0.5, (low, high)
    compute_along(server, "Chances", "hot_spot_chance(bands, 0.5, 199)")
    chance = value(server, "chances", 20, 50)["value"]
    near(chance * 200, round(chance * 200), 0.001)
    assert 0.005 <= chance <= 1, chance
    refused = compute(server, "Wide", "1 + focal_mean(bands, 50)", expect=422)
    assert "40 texels" in refused["detail"], refused
    assert (refused["field"], refused["offset"], refused["length"]) == (
        "expression",
        4,
        10,
    ), refused
    # The stated radius is allowed.
    most = refused["detail"].split("at most ")[1].split(" ")[0]
    compute_along(server, "Widest", f"focal_mean(bands, {most})")
    changed = server.request("PATCH", M + "/layers/widest", {"expression": "hot_spot(bands, 50)"})
    assert (changed.status, changed.json()["field"]) == (422, "expression"), changed


def test_a_preview_shows_what_a_layer_would_contain(server):
    camera = camera_from(server.get(M).json(), (0, 0, 1), 600, 600, up=(0, 1, 0))
    grid = {"camera": camera, "width": 60, "height": 60}

    def preview(expect=(200,), **layer):
        body = {"layer": {"name": "Preview", **layer}, "picture": grid}
        return server.ok("POST", M + "/layer-preview", body, expect=expect).json()

    before = server.get(M + "/layers").json()
    condition = "valid(pieces)"
    near_pieces = {"expression": f"distance({condition}, 5)", "resolution": 4096}
    seen = preview(**near_pieces)
    lowest = server.get(M).json()["atlas"]["lowest_resolution"]
    assert seen["resolution"] == max(1024, lowest) < 4096
    made = compute_along(server, "Near pieces", near_pieces["expression"])
    whole = server.get(f"{M}/layers/{made['slug']}/statistics").json()
    near(seen["statistics"]["area_m2"], whole["area_m2"], 0.03)
    near(seen["statistics"]["max"], whole["max"], 0.03)
    near(seen["share"], whole["area_m2"] / select(server, "true"), 0.03)
    server.ok("DELETE", f"{M}/layers/{made['slug']}")
    # the picture: colors on the pieces, gray elsewhere on the sheet, transparent elsewhere
    rows = pixels(base64.b64decode(preview(expression=condition)["picture"]), slice(0, 4))
    shown = [pixel for row in rows for pixel in row]
    assert len(shown) == 60 * 60
    empty = [pixel for pixel in shown if pixel[3] == 0]
    bare = [pixel for pixel in shown if pixel[3] and pixel[0] == pixel[1] == pixel[2]]
    painted = [pixel for pixel in shown if pixel[3] and pixel[0] != pixel[1]]
    assert empty and bare
    share = select(server, condition) / select(server, "true")
    near(len(painted) / (len(bare) + len(painted)), share, 0.15)
    # from the shape of the model, with its unit
    height = preview(compute={"kind": "height"})
    assert height["unit"] == "mm" and height["palette"]["mode"] == "linear", height["unit"]
    for layer, field in (
        ({}, "layer"),
        ({"expression": "valid(crcks)"}, "layer.expression"),
        ({"expression": f"distance({condition}, -1)"}, "layer.expression"),
        ({"expression": "focal_mean(wet, 50)"}, "layer.expression"),
        ({"compute": {"kind": "sun_hours"}}, "layer.compute.latitude_deg"),
        ({"expression": "wet", "compute": {"kind": "height"}}, "layer.expression"),
    ):
        assert preview(expect=(422,), **layer)["field"] == field, layer
    high = preview(expect=(422,), expression="300 + x", type="u8")
    assert high["field"] == "layer.type", high
    # it shows nothing that users of the layer could not see
    server.ok("POST", M + "/layers", {"name": "Hidden", "visibility": "private"})
    for visibility, status in (("public", 422), ("private", 200)):
        preview(expect=(status,), expression="valid(hidden)", visibility=visibility)
    server.ok("DELETE", M + "/layers/hidden")
    nearest = preview(expression="nearest(wet)")
    assert nearest["statistics"]["max"] == 0.75 and nearest["share"] > 0.99, nearest["share"]
    # The texels of the layer decide, 14 or 56 for this radius, and not those of the preview.
    wide = "focal_mean(wet, 0.7)"
    assert preview(expression=wide, resolution=2048)
    refused = preview(expect=(422,), expression=wide, resolution=8192)
    assert refused["field"] == "layer.expression" and "40 texels" in refused["detail"], refused
    assert server.get(M + "/layers").json() == before


def test_basins_and_water(server):
    """Two valleys along x = 25 and x = 75, and a wall with rain."""
    compute_along(server, "Basins", "watershed(min(abs(x - 25), abs(x - 75)), 10)")
    basins = [value(server, "basins", x, y)["value"] for x in (10, 45, 55, 90) for y in (20, 80)]
    assert basins[0] == basins[1] == basins[2] == basins[3], basins
    assert basins[4] == basins[5] == basins[6] == basins[7] == 3 - basins[0], basins
    compute_along(server, "Basin", "watershed(min(abs(x - 25), abs(x - 75)), 30)")
    near(select(server, "basin = 1"), server.get(M).json()["area_m2"], 1e-6)

    # 2 l/m² on a wall of 100 mm: 2 l/m² · 0.05 m at half of its height
    server.ok("PATCH", M, {"up": "y"})
    compute_along(server, "Water", "run_off(2)")
    near(value(server, "water", 30, 50)["value"], 0.1, 0.05)
    near(value(server, "water", 30, 10)["value"], 0.18, 0.05)
    # The surface faces down completely, so all water falls off where it is.
    server.ok("PATCH", M, {"up": "-z"})
    compute_along(server, "Dripping", "run_off(2)")
    assert value(server, "dripping", 50, 50)["value"] < 2 * 0.1e-3
    server.ok("PATCH", M, {"up": "z"})


def test_lines(server):
    """A groove of 4 texels, whose second half has half of the depth, and a separate shallow one."""
    depth = "case when y < 30 then 10 when y < 36 then 5 else 0 end"
    expression = (
        "case when x < 48 or x > 53 or y < 20 or y > 40 then null "
        f"when x between 49.9 and 50.1 then 20 - ({depth}) "
        "when x between 51.9 and 52.1 and y < 30 then 15 else 20 end"
    )
    compute(server, "Groove", expression)
    compute_along(server, "Depth", "valley(groove, 0.2)")
    for x, y, right in ((50, 25, 10), (50, 33, 5), (52, 25, 5)):
        near(value(server, "depth", x, y)["value"], right, 0.2)
    assert value(server, "depth", 51, 25)["value"] < 0.1
    assert not value(server, "depth", 60, 25)["valid"]
    compute_along(server, "Raised", "ridge(0 - groove, 0.2) - valley(groove, 0.2)")
    assert abs(value(server, "raised", 50, 25)["value"]) < 0.001
    cracks = compute_along(server, "Cracks", "hysteresis(valley(groove, 0.2), 2.5, 8)")
    assert cracks["type"] == "u8" and cracks["inputs"] == ["groove"], cracks
    for x, y, found in ((50, 25, True), (50, 33, True), (52, 25, False), (51, 25, False)):
        assert value(server, "cracks", x, y)["valid"] is found, (x, y)
    for width in (0.01, 50):
        refused = compute(server, "Other line", f"valley(groove, {width})", expect=422)
        assert refused["field"] == "expression" and "22 texels" in refused["detail"], refused


def test_cleanups(server):
    """A speck of 2 mm, a wide area with a hole of 2 mm, and a line of 1 mm."""
    speck = "(x between 10 and 12 and y between 10 and 12)"
    hole = "(x between 70 and 72 and y between 40 and 42)"
    line = "(x between 30 and 31)"
    points = [{"at": 1, "color": "#d55e00ff", "label": "A"}, {"at": 2, "color": "#0072b2ff"}]
    classes = compute(
        server,
        "Raw",
        f"case when {speck} or {line} then 1 when x > 50 and not {hole} then 2 end",
        type="u8",
        palette={"mode": "categorical", "points": points},
    )["palette"]
    places = {"speck": (11, 11), "hole": (71, 41), "line": (30.5, 80), "area": (60, 60)}
    raw = {"speck": 1, "hole": None, "line": 1, "area": 2}
    for name, expression, changed in (
        ("Sieved", "sieve(raw, 9)", {"speck": None}),
        ("Filled", "fill_holes(raw, 9)", {"hole": 2}),
        ("Both", "fill_holes(sieve(raw, 9), 9)", {"speck": None, "hole": 2}),
        ("Smooth", "majority(raw, 1.5)", {"line": None}),
    ):
        layer = compute_along(server, name, expression)
        assert (layer["type"], layer["palette"]) == ("u8", classes), layer
        for place, right in (raw | changed).items():
            read = value(server, name.lower(), *places[place])
            assert (read["value"] if read["valid"] else None) == right, (expression, place, read)
    for name, expression, inside in (
        ("Large", "sieve(valid(raw), 9)", {"line", "area"}),
        ("Closed", "closing(raw, 4)", {"speck", "hole", "line", "area"}),
        ("Opened", "opening(raw = 1, 1.5)", {"speck"}),
    ):
        layer = compute_along(server, name, expression)
        assert layer["type"] == "u8", layer
        for place, at in places.items():
            assert value(server, name.lower(), *at)["valid"] is (place in inside), (name, place)
    refused = compute(server, "Wide", "majority(raw, 50)", expect=422)
    assert refused["field"] == "expression" and "40 texels" in refused["detail"], refused


def test_interpolation(server):
    """Readings of a plane, 20 + x / 10, at 16 spots. Each spot of one value is one reading."""
    server.ok("POST", M + "/layers", {"name": "Moisture", "type": "f32", "resolution": 2048})
    for x in (12, 37, 62, 87):
        for y in (12, 37, 62, 87):
            dab(server, f"{M}/layers/moisture", 20 + x / 10, x, y, 2)
    mean = compute_along(server, "Interpolated", "interpolated(moisture, 100)")
    assert mean["type"] == "f32" and mean["inputs"] == ["moisture"], mean
    for x, y in ((25, 25), (50, 50), (75, 30), (62, 62)):
        near(value(server, "interpolated", x, y)["value"], 20 + x / 10, 0.02)
    compute_along(server, "Error", "interpolation_error(moisture, 100)")
    at_reading = value(server, "error", 37, 37)["value"]
    between, outside = (value(server, "error", *at)["value"] for at in ((50, 50), (99, 99)))
    assert 0 < at_reading < between < outside < 5, (at_reading, between, outside)
    # the functions in one formula, and places where the readings decide
    compute_along(server, "Damp", "interpolated(moisture, 100) > 25", type="u8")
    near(server.get(M + "/layers/damp/statistics").json()["area_m2"], 50 * 100 * 1e-6, 0.05)

    for expression, text in (
        ("interpolated(moisture, 1000)", "or less"),
        ("interpolated(if(moisture > 28 and y > 50, 1, null), 100)", "Readings found"),
        ("interpolation_error(moisture * 0, 100)", "same value"),
    ):
        job = compute(server, "Refused", expression, expect=202)
        done = server.wait_for_job(job["id"])
        assert done["state"] == "failed", done
        assert done["problem"]["field"] == "expression", done
        assert text in done["problem"]["detail"], done
    for layer_range in (0, 0.1):
        refused = compute(server, "Refused", f"interpolated(moisture, {layer_range})", expect=422)
        assert refused["field"] == "expression" and "20 texels" in refused["detail"], refused


def test_distances_work_in_computed_layers_only(server):
    def refused(answer, reason, field):
        problem = answer.json()
        assert (answer.status, problem["reason"], problem["field"]) == (422, reason, field), problem
        return problem

    for answer, field in (
        (server.post(M + "/select", {"where": "within(pieces, 5)"}), "where"),
        (server.post(M + "/select", {"where": "distance(pieces.state = 'loose') < 5"}), "where"),
        (
            server.post(
                M + "/layers/wet/edits",
                {"op": "fill", "mode": "where", "where": "nearest(pieces) = 1", "value": 1},
            ),
            "where",
        ),
        (
            server.get(
                f"{M}/layers/wet/statistics?" + urllib.parse.urlencode({"where": "within(wet, 5)"})
            ),
            "where",
        ),
        (
            server.get(
                "/tables/pieces/records?"
                + urllib.parse.urlencode({"filter": "distance(thickness > 1) < 5"})
            ),
            "filter",
        ),
    ):
        problem = refused(answer, "computed_layers_only", field)
        assert "computed layer" in problem["detail"] and problem["length"] > 5, problem

    many = " + ".join(f"distance(wet, {number})" for number in range(1, 10))
    for expression, reason in (
        ("distance(wte > 0)", "unknown_layer"),
        ("distance(pieces.thick > 0)", "unknown_column"),
        ("distance(wet + 1)", "expects_condition"),
        ("distance(wet, 5 mm)", "unit"),
        ("distance(wet, dry)", "syntax"),
        (many, "too_large"),
    ):
        answer = server.post(
            M + "/layers", {"name": "Bad", "expression": expression, "resolution": 2048}
        )
        refused(answer, reason, "expression")


def test_they_are_computed_anew_by_themselves(server):
    """An automatic layer can depend on another automatic layer."""
    for name in ("risk", "mask"):
        assert (
            server.ok("PATCH", f"{M}/layers/{name}", {"recompute": "automatic"}).json()["recompute"]
            == "automatic"
        )
    dab(server, f"{M}/layers/wet", 0.75, 30, 30, 4)
    wait_for(lambda: value(server, "mask", 30, 30).get("value") == 1, "the layers to follow")
    wait_for(
        lambda: not server.get(M + "/layers/mask").json()["stale"], "the layer to be up to date"
    )
    server.ok("PATCH", "/tables/pieces/records/1", {"values": {"state": "loose"}})
    wait_for(lambda: value(server, "risk", 30, 30)["value"] == 7.5, "a record to reach the surface")

    # without its expression the layer is an ordinary layer
    plain = server.ok("PATCH", M + "/layers/mask", {"expression": ""}).json()
    assert "expression" not in plain and value(server, "mask", 30, 30)["value"] == 1
    dab(server, f"{M}/layers/mask", 7, 30, 30, 3)
    assert value(server, "mask", 30, 30)["value"] == 7

    # the error contains the name of the deleted input
    compute(server, "Twice", "mask * 2")
    server.ok("DELETE", M + "/layers/mask")
    answer = server.post(M + "/layers/twice/compute")
    assert answer.status == 409 and "'mask', which was deleted" in answer.json()["detail"], answer
    assert server.get(M + "/layers/twice").json()["stale"] is True


def test_another_unit_or_upward_direction_makes_them_stale(server):
    """Layers that follow their inputs are computed again."""
    server.import_model(folded_grid(), "turned.ply", name="Turned", unit="mm")
    turned = "/models/turned"
    for name, recompute in (("Steep", "manual"), ("Level", "automatic")):
        wish = {"name": name, "expression": "slope", "recompute": recompute, "resolution": 2048}
        job = server.ok("POST", turned + "/layers", wish, expect=(202,)).json()["id"]
        assert server.wait_for_job(job)["state"] == "done"

    def is_stale(layer):
        found = server.get(f"{turned}/layers/{layer}").json()
        assert found["stale"] or found["computed_sequence"] > 0, found
        return found["stale"]

    def mean(layer):
        return server.get(f"{turned}/layers/{layer}/statistics").json()["mean"]

    before = mean("level")
    server.ok("PATCH", turned, {"name": "Turned", "credit": "Ada"})
    assert not is_stale("steep")
    server.ok("PATCH", turned, {"up": "y"})
    assert is_stale("steep")
    assert "computed_sequence" not in server.get(turned + "/layers/steep").json()
    wait_for(lambda: not is_stale("level"), "the automatic layer to be up to date")
    assert abs(mean("level") - before) > 10 and mean("steep") == before
    assert server.ok("POST", turned + "/layers/steep/compute", expect=(200, 202)).status
    wait_for(lambda: not is_stale("steep"), "the other layer to be up to date")
    near(mean("steep"), mean("level"), 1e-9)
    server.ok("PATCH", turned, {"unit": "cm"})
    assert is_stale("steep")


def test_transfer(server):
    """The values are transferred to another scan, even without the inputs."""
    server.import_model(folded_grid(fold=0.001), "again.ply", name="Again", unit="mm")
    job = server.wait_for_job(
        server.ok(
            "POST",
            "/models/again/transfer",
            {"from": "sheet", "layers": ["risk"], "tolerance_mm": 1},
        ).json()["id"]
    )
    assert job["state"] == "done", job
    path = f"/models/again/layers/{job['layers'][0]}"
    assert "expression" not in server.get(path).json()
    there, here = (server.get(each + "/statistics").json() for each in (M + "/layers/risk", path))
    near(here["area_m2"], there["area_m2"], 0.02)
    assert here["max"] == there["max"], (here, there)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
