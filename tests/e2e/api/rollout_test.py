"""Rollouts: the unrolled surface of vessels as a picture whose lengths and areas are those of the
vessel. The sheet that comes with the picture gives the place of each pixel. Figures show rollouts
to scale, with rulers."""
import json
import math
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree as xml

import numpy
import pytest
from support import tiff
from support.cameras import camera_from
from support.meshes import bumpy_ball, folded_grid, pillar, vessel
from support.pictures import pixels

RED = (255, 0, 0)
# Two discs on the wall. The second one is at the back, on the cut.
PAINTED = (
    "(x - 40) * (x - 40) + y * y + (z - 30) * (z - 30) < 144"
    " or (x + 30) * (x + 30) + (y - 30) * (y - 30) + (z - 50) * (z - 50) < 144"
)


def rollout(server, model, expect=200, accept="image/png", **wish):
    answer = server.request("POST", f"/models/{model}/rollout", wish, headers={"Accept": accept})
    assert answer.status == expect, (wish, answer)
    return answer


def drawn(server, model, **wish):
    """Returns the pixels as rows × columns × 4, and the sheet."""
    answer = rollout(server, model, **wish)
    sheet = json.loads(answer.headers["Strata-Rollout"])
    rows = numpy.array(pixels(answer.body, slice(0, 4)))
    assert rows.shape[:2] == (sheet["height"], sheet["width"]), (rows.shape, sheet)
    return rows, sheet


def is_red(rows):
    return (rows[:, :, 0] > 200) & (rows[:, :, 1] < 60) & (rows[:, :, 2] < 60)


def place_of(sheet, column, row):
    """Returns the point on the cylinder or cone at the center of a pixel, as the guide explains."""
    unit = sheet["units_per_pixel"]
    x = sheet["left"] + (column + 0.5) * unit
    y = sheet["top"] - (row + 0.5) * unit
    if sheet["side"] == "inside":
        x = -x
    middle = math.radians(sheet["from"] + sheet["to"]) / 2
    sine, cosine = (f(math.radians(sheet["half_angle"])) for f in (math.sin, math.cos))
    if sheet["shape"] == "cylinder":
        angle, slant = middle + x / sheet["radius"], y
    else:
        apex, sign = -sheet["radius"] / sine, math.copysign(1, sine)
        slant = apex + sign * math.hypot(x, y - apex)
        angle = middle + math.atan2(x, sign * (y - apex)) / abs(sine)
    axis, zero = numpy.array(sheet["axis"]["direction"]), numpy.array(sheet["zero"])
    radial = math.cos(angle) * zero + math.sin(angle) * numpy.cross(axis, zero)
    return (
        numpy.array(sheet["axis"]["point"])
        + (sheet["radius"] + slant * sine) * radial
        + slant * cosine * axis
    )


@pytest.fixture(scope="module")
def server(server):
    for name, slope in (("column", 0.0), ("bowl", 0.1)):
        server.import_model(vessel(slope=slope), f"{name}.ply", name=name, unit="mm")
        server.ok(
            "POST",
            f"/models/{name}/layers",
            {
                "name": "Marks",
                "type": "u8",
                "resolution": 2048,
                "palette": {"mode": "categorical", "points": [{"at": 1, "color": "#ff0000"}]},
            },
        )
        server.ok(
            "POST",
            f"/models/{name}/layers/marks/edits",
            {"op": "fill", "mode": "where", "where": PAINTED, "value": 1},
        )
    server.import_model(pillar(), "pillar.ply", name="pillar", unit="mm")
    server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    return server


def test_the_sheet_has_the_size_of_the_cylinder(server):
    sheet = rollout(server, "column", accept="application/json", mm_per_pixel=0.25).json()
    assert sheet["shape"] == "cylinder" and sheet["side"] == "outside", sheet
    assert abs(sheet["radius"] - 40) < 0.04 and sheet["deviation"] < 0.04, sheet
    assert abs(sheet["width"] * 0.25 - 2 * math.pi * 40) < 0.5, sheet
    assert abs(sheet["height"] * 0.25 - 80) < 0.3, sheet
    assert abs(sheet["axis"]["direction"][2] - 1) < 1e-6, sheet
    assert abs(sheet["to"] - sheet["from"] - 360) < 1e-6, sheet


@pytest.mark.parametrize("model", ["column", "bowl"])
def test_painted_areas_are_those_of_the_statistics(server, model):
    rows, sheet = drawn(server, model, mm_per_pixel=0.25)
    area_m2 = is_red(rows).sum() * (0.25 / 1000) ** 2
    expected = server.ok("GET", f"/models/{model}/layers/marks/statistics").json()["area_m2"]
    assert abs(area_m2 - expected) < 0.01 * expected, (area_m2, expected)
    assert sheet["shape"] == ("cylinder" if model == "column" else "cone")


@pytest.mark.parametrize("model", ["column", "bowl"])
@pytest.mark.parametrize("cut", [None, 0, 135])
def test_the_sheet_gives_the_place_of_each_pixel(server, model, cut):
    rows, sheet = drawn(server, model, mm_per_pixel=0.5, **({} if cut is None else {"cut": cut}))
    red = is_red(rows)
    checked = 0
    for row in range(0, sheet["height"], 7):
        for column in range(0, sheet["width"], 7):
            if rows[row, column, 3] == 0:
                continue
            x, y, z = place_of(sheet, column, row)
            radius = 40 + (0.1 * z if model == "bowl" else 0)
            assert abs(math.hypot(x, y) - radius) < 0.1, (x, y, z)
            depths = (
                math.dist((x, y, z), (40, 0, 30)) - 12,
                math.dist((x, y, z), (-30, 30, 50)) - 12,
            )
            if min(abs(depth) for depth in depths) > 1:
                assert red[row, column] == (min(depths) < 0), (x, y, z)
                checked += 1
    assert checked > 1000


def test_a_pixel_without_a_surface_is_transparent(server):
    rows, _ = drawn(server, "bowl", mm_per_pixel=1)
    assert set(numpy.unique(rows[:, :, 3])) == {0, 255}


def test_the_picture_shows_the_requested_state_and_layers(server):
    rows, _ = drawn(server, "column", mm_per_pixel=1, at=0)
    assert not is_red(rows).any()
    rows, _ = drawn(server, "column", mm_per_pixel=1, layers=[{"layer": "marks", "visible": False}])
    assert not is_red(rows).any()
    blue = {"mode": "categorical", "points": [{"at": 1, "color": "#0000ff"}]}
    rows, _ = drawn(
        server, "column", mm_per_pixel=1, layers=[{"layer": "marks", "palette": blue}], relief=False
    )
    assert (rows == (0, 0, 255, 255)).all(axis=2).any()
    assert server.request("POST", "/models/column/rollout", {"at": 10**9}).status == 422


def test_the_sheet_of_a_response_can_be_requested_again(server):
    first = rollout(server, "bowl", accept="application/json").json()
    again = rollout(
        server,
        "bowl",
        accept="application/json",
        axis=first["axis"],
        radius=first["radius"],
        half_angle=first["half_angle"],
        side=first["side"],
        cut=first["from"],
        mm_per_pixel=first["mm_per_pixel"],
    ).json()
    for name in ("left", "top", "width", "height", "from", "to"):
        assert abs(first[name] - again[name]) < 1e-3, (name, first, again)
    assert max(first["width"], first["height"]) == 2000, first


def test_a_pillar_is_unrolled_along_its_cross_section(server):
    answer = rollout(server, "pillar", shape="general_cylinder", mm_per_pixel=0.25)
    header = json.loads(answer.headers["Strata-Rollout"])
    sheet = rollout(
        server, "pillar", shape="general_cylinder", mm_per_pixel=0.25, accept="application/json"
    ).json()
    section = sheet.pop("section")
    assert header == sheet and sheet["shape"] == "general_cylinder", (header, sheet)
    assert abs(sheet["width"] * 0.25 - 200) < 1 and abs(sheet["height"] * 0.25 - 80) < 0.5, sheet
    assert abs(sheet["radius"] * 2 * math.pi - 200) < 1, sheet
    # The corners of the section are on the walls.
    axis, zero = numpy.array(sheet["axis"]["direction"]), numpy.array(sheet["zero"])
    for i, radius in enumerate(section):
        angle = 2 * math.pi * i / len(section)
        x, y, _ = numpy.array(sheet["axis"]["point"]) + radius * (
            math.cos(angle) * zero + math.sin(angle) * numpy.cross(axis, zero)
        )
        assert abs(max(abs(x) / 30, abs(y) / 20) - 1) < 0.01, (i, x, y)
    # The cut is at the back by default.
    rows = numpy.array(pixels(answer.body, slice(0, 4)))
    assert (rows[:, 5:-5, 3] == 255).all()
    answer = server.request(
        "POST",
        "/models/pillar/figures",
        {"rollout": {"shape": "general_cylinder"}, "format": "svg", "dpi": 50, "scale": 2},
    )
    angles = ruler(answer.body, "angle-ruler")
    # From the middle of a narrow wall at 90° to that of a wide wall at 180° or 0° are 50 mm.
    places = {text: place for place, text in angles}
    assert abs(abs(places["90°"] - places["0°"])[0] - 50 / 2) < 0.3, angles


def test_models_without_an_axis_are_refused(server):
    for model in ("sheet", "ball"):
        problem = rollout(server, model, expect=422).json()
        assert problem["field"] == "axis" and "Set the axis" in problem["detail"], problem
    axis = {"point": [0, 0, 0], "direction": [0, 0, 2]}
    assert rollout(server, "ball", axis=axis, accept="application/json").json()["radius"] > 30


def test_faulty_requests_name_the_field(server):
    axis = {"point": [0, 0, 0], "direction": [0, 0, 1]}
    for field, status, wish in (
        ("axis.direction", 422, {"axis": {"point": [0, 0, 0], "direction": [0, 0, 0]}}),
        ("radius", 422, {"radius": 5}),
        ("half_angle", 422, {"axis": axis, "half_angle": 5}),
        ("shape", 422, {"axis": axis, "radius": 5, "shape": "cone"}),
        ("side", 422, {"side": "inside"}),
        ("mm_per_pixel", 413, {"mm_per_pixel": 0.001}),
        # 6.3 million × 1 pixels
        ("mm_per_pixel", 413, {"axis": axis, "radius": 1e9, "mm_per_pixel": 1000}),
        ("mm_per_pixel", 422, {"mm_per_pixel": 0}),
        ("layers[0].layer", 404, {"layers": [{"layer": "nothing"}]}),
    ):
        problem = rollout(server, "column", expect=status, **wish).json()
        assert problem["field"] == field, (wish, problem)


SVG = "{http://www.w3.org/2000/svg}"
BARE = {"legend": False, "title": "", "credit": ""}


def figure(server, model, expect=200, **wish):
    answer = server.request("POST", f"/models/{model}/figures", {"rollout": {}, **wish})
    assert answer.status == expect, (wish, answer)
    return answer


def ruler(svg, name):
    """Returns the labeled ticks of a ruler, as pairs of the place on the outline and the text."""
    group = next(each for each in xml.fromstring(svg).iter(SVG + "g") if each.get("id") == name)
    ticks, place = [], None
    for item in group:
        if item.tag == SVG + "path":
            numbers = [float(each) for each in re.findall(r"[-+.e\d]+", item.get("d"))]
            place = numpy.array(numbers[:2])
        else:
            ticks.append((place, item.text))
    return ticks


def test_a_figure_of_a_rollout_has_rulers_at_its_scale(server):
    svg = figure(server, "column", format="svg", dpi=50, scale=2).body
    angles = ruler(svg, "angle-ruler")
    assert [text for _, text in angles] == ["180°", "225°", "270°", "315°", "0°", "45°", "90°"] + [
        "135°",
        "180°",
    ], angles
    for (place, _), (after, _) in zip(angles, angles[1:]):
        assert numpy.allclose(after - place, (2 * math.pi * 40 / 8 / 2, 0), atol=0.03), angles
    lengths = ruler(svg, "length-ruler")
    assert [text for _, text in lengths] == ["0", "20", "40", "60", "80 mm"], lengths
    for (place, _), (after, _) in zip(lengths, lengths[1:]):
        assert numpy.allclose(after - place, (0, -10), atol=0.01), lengths
    assert abs(lengths[0][0] - angles[0][0]).max() < 0.01, (lengths, angles)
    texts = [each.text for each in xml.fromstring(svg).iter(SVG + "text")]
    assert "1 : 2" in texts and "Marks" in texts and "column" in texts, texts
    # with an axis, the lengths begin at its point
    axis = {"point": [0, 0, 30], "direction": [0, 0, 1]}
    lengths = ruler(
        figure(server, "column", format="svg", dpi=50, scale=2, rollout={"axis": axis}).body,
        "length-ruler",
    )
    assert [text for _, text in lengths] == ["-20", "0", "20", "40 mm"], lengths


def test_the_rulers_of_a_cone_are_along_its_slant(server):
    svg = figure(server, "bowl", format="svg", dpi=50, scale=2.5).body
    lengths = ruler(svg, "length-ruler")
    assert len(lengths) > 2, lengths
    for (place, text), (after, _) in zip(lengths, lengths[1:]):
        assert abs(math.dist(place, after) - 20 / 2.5) < 0.01, lengths
    angles = ruler(svg, "angle-ruler")
    slant = 40 / math.sin(math.atan(0.1)) + 80 * math.hypot(1, 0.1)  # to the upper edge
    step = math.radians(int(angles[1][1][:-1]) - int(angles[0][1][:-1])) * math.sin(math.atan(0.1))
    for (place, _), (after, _) in zip(angles, angles[1:]):
        chord = 2 * slant * math.sin(step / 2) / 2.5
        assert abs(math.dist(place, after) - chord) < 0.05, (angles, chord)


@pytest.mark.parametrize("model", ["column", "bowl"])
def test_areas_on_the_paper_are_to_scale(server, model):
    wish = {"format": "tiff", "dpi": 150, "scale": 2, "rollout": {"relief": False}, **BARE}
    rows, _ = tiff.read(figure(server, model, **wish).body)
    area_m2 = is_red(rows).sum() * (25.4 / 150 * 2 / 1000) ** 2
    expected = server.ok("GET", f"/models/{model}/layers/marks/statistics").json()["area_m2"]
    assert abs(area_m2 - expected) < 0.01 * expected, (area_m2, expected)
    assert not is_red(tiff.read(figure(server, model, at=0, **wish).body)[0]).any()


def test_the_file_of_a_rollout_has_the_size_of_the_paper_and_the_texts(server):
    pdf = figure(server, "column", dpi=50, caption="Unrolled")
    assert "column-rollout-1-2.pdf" in pdf.headers["Content-Disposition"], pdf.headers
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "rollout.pdf")
        with open(path, "wb") as out:
            out.write(pdf.body)
        facts = subprocess.run(["pdfinfo", path], capture_output=True, check=True, text=True).stdout
        words = subprocess.run(
            ["pdftotext", "-layout", path, "-"], capture_output=True, check=True, text=True
        ).stdout
    assert re.search(r"Page size:\s+841\.\d+ x 595\.\d+ pts \(A4\)", facts), facts
    for expected in ("1:2", "Unrolled", "Marks", "180°", "80 mm"):
        assert expected in words.replace(" : ", ":"), (expected, words)


def test_the_legend_of_a_rollout_lists_what_it_shows(server):
    texts = lambda **wish: [
        each.text
        for each in xml.fromstring(
            figure(server, "column", format="svg", dpi=50, **wish).body
        ).iter(SVG + "text")
    ]
    assert "Marks" in texts()
    assert "Marks" not in texts(at=0)
    assert "Marks" not in texts(legend=False)
    # a saved view sets the layers
    model = server.ok("GET", "/models/column").json()
    hidden = {"name": "Bare", "camera": camera_from(model, (0, -1, 0))}
    hidden["layers"] = [{"layer": "marks", "visible": False}]
    view = server.ok("POST", "/models/column/views", hidden).json()
    assert "Marks" not in texts(view=view["slug"])


def test_faulty_figures_of_rollouts_name_the_field(server):
    axis = {"point": [0, 0, 0], "direction": [0, 0, 0]}
    camera = camera_from(server.ok("GET", "/models/column").json(), (0, -1, 0))
    for model, field, wish in (
        ("column", "rollout.axis.direction", {"rollout": {"axis": axis}}),
        ("column", "rollout.radius", {"rollout": {"radius": 5}}),
        ("column", "rollout.side", {"rollout": {"side": "inside"}}),
        ("ball", "rollout.axis", {}),
        ("column", "camera", {"camera": camera}),
        ("column", "light", {"light": {"mode": "unlit"}}),
        ("column", "direction", {"direction": "top"}),
        ("column", "normal", {"normal": [0, 0, 1]}),
        ("column", "center", {"center": [0, 0, 1]}),
        ("column", "labels", {"labels": {"layer": "marks", "column": "name"}}),
    ):
        problem = figure(server, model, expect=422, **wish).json()
        assert problem["field"] == field, (wish, problem)
