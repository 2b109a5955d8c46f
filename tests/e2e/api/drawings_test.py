"""Figures whose areas are vectors: outlines in SVG and PDF have the areas and borders of the layer,
keep patterns and the order of layers, and a DXF file has the same areas in millimeters on the
object."""
import math
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree as xml

import ezdxf
import numpy
import pytest
from support.meshes import folded_grid
from support.pictures import pixels

M = "/models/sheet"  # a flat sheet with x and y from 0 to 100 mm
SVG = "{http://www.w3.org/2000/svg}"
BARE = {"legend": False, "light": {"mode": "unlit"}, "looks": [], "title": "", "credit": ""}
TOP = {"direction": "top", "scale": 1, "paper": "a5", "dpi": 100, **BARE}
RADIUS = 20


def figure(server, expect=200, **wish):
    answer = server.request("POST", f"{M}/figures", wish)
    assert answer.status == expect, (wish, answer)
    return answer


def fill(server, layer, where, value):
    server.ok(
        "POST",
        f"{M}/layers/{layer}/edits",
        {"op": "fill", "mode": "where", "where": where, "value": value},
    )


@pytest.fixture(scope="module")
def server(server):
    """Class 1 is a disc with a hole. Class 2 is the rest of the left half and touches the disc.
    Class 3 is hatched."""
    server.import_model(folded_grid(cells=10, fold=0.0), "sheet.ply", name="Sheet", unit="mm")
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Schäden 損傷",
            "slug": "marks",
            "type": "u8",
            "resolution": 2048,
            "opacity": 1,
            "palette": {
                "mode": "categorical",
                "points": [
                    {"at": 1, "color": "#ff0000", "label": "Riß: tief/breit"},
                    {"at": 2, "color": "#0000ff", "label": "Salt"},
                    {"at": 3, "color": "#008000", "label": "Soot", "pattern": "hatch", "angle": 30},
                ],
            },
        },
    )
    fill(server, "marks", "x < 50", 2)
    disc = "(x - 50) * (x - 50) + (y - 50) * (y - 50)"
    fill(server, "marks", f"{disc} < {RADIUS * RADIUS}", 1)
    server.ok(
        "POST",
        f"{M}/layers/marks/edits",
        {"op": "fill", "mode": "where", "where": f"{disc} < 25", "erase": True},
    )
    fill(server, "marks", "x > 80 and y > 60", 3)
    server.ok(
        "POST", M + "/layers", {"name": "Damp", "type": "f32", "resolution": 2048, "visible": False}
    )
    fill(server, "damp", "y < 20", 0.5)
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Cracks",
            "columns": [
                {"name": "Code"},
                {"name": "Path", "kind": "line"},
                {"name": "Sample", "kind": "point"},
            ],
        },
    )
    cracks = {"name": "Cracks", "kind": "database", "type": "u16", "table": "cracks"}
    server.ok("POST", M + "/layers", {**cracks, "resolution": 2048, "visible": False})
    model = server.get(M).json()["id"]
    for code, column, places in (
        ("Long", "path", [[0, 50, 0], [50, 50, 0], [50, 60, 0]]),
        ("Below", "path", [[40, 40, -0.4], [60, 40, -0.4]]),  # the sheet hides it
        ("Inside", "sample", [[70, 20, 0]]),
        ("Outside", "sample", [[95, 50, 0]]),
    ):
        place = [{"model": model, "coordinates": places}]
        server.ok("POST", "/tables/cracks/records", {"values": {"code": code, column: place}})
    return server


def rings_of(path):
    """Returns the rings of an SVG path as rows of x and y."""
    return [
        numpy.array(re.findall(r"-?[\d.]+(?:e-?\d+)?", ring), float).reshape(-1, 2)
        for ring in path.split("Z")
        if ring
    ]


def area_of(ring):
    x, y = (ring - ring[0]).T
    return (x * numpy.roll(y, -1) - y * numpy.roll(x, -1)).sum() / 2


def groups_of(svg):
    return {each.get("id"): each for each in xml.fromstring(svg).iter(SVG + "g")}


def area_rings(group):
    return [ring for path in group.iter(SVG + "path") for ring in rings_of(path.get("d"))]


def test_outlines_are_smooth_and_shared(server):
    svg = figure(server, format="svg", areas="outlines", **TOP).body
    groups = groups_of(svg)
    layer = groups["areas-marks"]
    assert layer.find(SVG + "title").text == "Schäden 損傷"
    names = [each.find(SVG + "title").text for each in layer.findall(SVG + "g")]
    assert names == ["Riß: tief/breit", "Salt", "Soot"], names
    red, blue = (area_rings(groups[f"areas-marks-{value}"]) for value in (1, 2))
    assert len(red) == 2 and len(blue) == 1
    sizes = sorted(abs(area_of(ring)) for ring in red)
    for size, radius in zip(sizes, (5, RADIUS)):
        # the tolerance of 0.1 mm, and half a cell
        assert abs(size - math.pi * radius**2) < 2 * math.pi * radius * 0.05, (size, radius)
    outer = max(red, key=lambda ring: abs(area_of(ring)))
    middle = (outer.min(axis=0) + outer.max(axis=0)) / 2
    away = numpy.hypot(*(outer - middle).T)
    assert abs(away - RADIUS).max() < 0.15, away
    assert len(outer) < 400  # a circle of cells has about 1900 corners
    # stairs would make the outline 27 % longer
    length = numpy.hypot(*(outer - numpy.roll(outer, 1, axis=0)).T).sum()
    assert abs(length / (2 * math.pi * RADIUS) - 1) < 0.01, length
    shared = {tuple(point) for point in outer} & {tuple(point) for point in blue[0]}
    assert len(shared) > 30, len(shared)
    # The sum of the areas is that of the left half and the right half of the disc.
    total = abs(area_of(blue[0])) + abs(area_of(outer))
    assert abs(total - (5000 + math.pi * RADIUS**2 / 2)) < 10, total
    # Another tolerance has fewer points.
    coarse = groups_of(figure(server, format="svg", areas="outlines", tolerance_mm=1, **TOP).body)
    few = max(area_rings(coarse["areas-marks-1"]), key=lambda ring: abs(area_of(ring)))
    assert len(few) < len(outer), (len(few), len(outer))


def test_patterns_are_vectors(server):
    group = groups_of(figure(server, format="svg", areas="outlines", **TOP).body)["areas-marks-3"]
    clip = group.find(f"{SVG}clipPath/{SVG}path")
    assert abs(abs(area_of(rings_of(clip.get("d"))[0])) - 20 * 40) < 5
    lines = next(each for each in group.iter(SVG + "path") if each.get("stroke-width"))
    ends = numpy.array(re.findall(r"-?[\d.]+", lines.get("d")), float).reshape(-1, 2, 2)
    along = ends[:, 1] - ends[:, 0]
    assert abs(numpy.degrees(numpy.arctan2(-along[:, 1], along[:, 0])) - 30).max() < 0.1
    across = numpy.array([0.5, math.cos(math.radians(30))])
    steps = numpy.diff(sorted(ends[:, 0] @ across))
    assert abs(steps - 7 * 0.254).max() < 0.01, steps  # the spacing of hatches in pictures


def pdf_pixels(body, dpi):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "figure.pdf")
        with open(path, "wb") as out:
            out.write(body)
        subprocess.run(
            ["pdftoppm", "-r", str(dpi), "-png", "-singlefile", path, path[:-4]], check=True
        )
        with open(path[:-4] + ".png", "rb") as page:
            return numpy.array(pixels(page.read())).astype(int)


def test_a_pdf_looks_like_the_picture(server):
    """Outlines have the colors, the patterns and the places of the pixels. Between neighbors, no
    light line is visible."""
    wish = {**TOP, "dpi": 150}
    drawn = pdf_pixels(figure(server, format="pdf", areas="outlines", **wish).body, 100)
    pictured = pdf_pixels(figure(server, format="pdf", **wish).body, 100)
    for color in ((255, 0, 0), (0, 0, 255), (0, 128, 0)):
        counts = [(abs(each - color) < 60).all(axis=2).sum() for each in (drawn, pictured)]
        # The edges of a hatch's lines are mixed colors, which depend on where the pixels are.
        most = 0.12 if color == (0, 128, 0) else 0.06
        assert counts[1] > 500 and abs(counts[0] / counts[1] - 1) < most, (color, counts)
    differs = (abs(drawn - pictured) > 80).any(axis=2)
    assert differs.mean() < 0.01, differs.mean()
    # A row through the left border of the disc, from blue to red.
    red = numpy.argwhere((abs(drawn - (255, 0, 0)) < 60).all(axis=2))
    middle = drawn[(red[:, 0].min() + red[:, 0].max()) // 2]
    first = red[:, 1].min()
    assert (middle[first - 5 : first + 5, 1] < 60).all(), middle[first - 5 : first + 5]


def test_the_order_of_layers_stays(server):
    """A layer of decimal numbers above the classes keeps them in the picture."""
    above = [{"layer": "damp", "visible": True, "order": 1000}]
    below = [{"layer": "damp", "visible": True, "order": -1000}]
    for layers, is_outlined in ((above, False), (below, True)):
        groups = groups_of(
            figure(server, format="svg", areas="outlines", layers=layers, **TOP).body
        )
        assert ("areas-marks" in groups) == is_outlined, (layers, groups)
        assert "areas-damp" not in groups
    faded = [{"layer": "marks", "opacity": 0.5}, {"layer": "damp", "visible": False}]
    group = groups_of(figure(server, format="svg", areas="outlines", layers=faded, **TOP).body)[
        "areas-marks"
    ]
    assert group.get("opacity") == "0.5"


def drawing_of(answer):
    """The DXF file, as a reader of CAD files understands it without finding a problem."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sheet.dxf")
        with open(path, "wb") as out:
            out.write(answer.body)
        document = ezdxf.readfile(path)
    problems = document.audit()
    assert not problems.errors and not problems.fixes, (problems.errors, problems.fixes)
    return document


def attributes_of(entity):
    data = [tag.value for tag in entity.get_xdata("STRATA")]
    return dict(zip(data[::2], data[1::2]))


CUT = {**TOP, "scale": 0.5, "format": "dxf"}  # the drawing is smaller than the sheet


def test_marks_in_dxf(server):
    """Lines end at the edge of the drawing and keep only their own corners. What the surface hides
    is absent."""
    layers = [{"layer": "cracks", "visible": True}, {"layer": "marks", "visible": False}]
    document = drawing_of(figure(server, layers=layers, **CUT))
    found = {attributes_of(each)["class"]: each for each in document.modelspace()}
    assert sorted(found) == ["Inside", "Long"], found
    assert attributes_of(found["Inside"])["layer"] == "Cracks"
    assert [round(each, 3) for each in found["Inside"].dxf.location] == [70, 20, 0]
    corners = [tuple(round(each, 3) for each in point) for point in found["Long"].get_points("xy")]
    assert corners[1:] == [(50, 50), (50, 60)] and corners[0][1] == 50, corners
    assert 1 < corners[0][0] < 40, corners
    assert document.header["$EXTMAX"][0] == 70
    assert found["Long"].rgb is not None and found["Inside"].rgb is not None


def test_the_texts_of_a_sheet_do_not_change_a_dxf_file(server):
    """A long caption and a legend take space on a sheet, but a DXF file has no sheet."""
    words = {"title": "Title", "caption": "A long caption. " * 40, "legend": True}
    extents = []
    for more in ({}, words):
        header = drawing_of(figure(server, **{**CUT, **more})).header
        extents.append((header["$EXTMIN"], header["$EXTMAX"]))
    assert extents[0] == extents[1], extents


def test_a_dxf_file_without_content_is_refused(server):
    hidden = [{"layer": "marks", "visible": False}]
    answer = figure(server, 422, layers=hidden, format="dxf", **TOP)
    assert answer.json()["field"] == "format" and "Show a layer" in answer.json()["detail"], answer


def test_dxf(server):
    """A reader of CAD files finds no problem, and the areas of the quantities."""
    answer = figure(server, format="dxf", **{**TOP, "scale": 2.5})
    assert answer.headers["Content-Type"] == "image/vnd.dxf"
    assert answer.headers["Content-Disposition"].endswith("sheet-top-1-2.5.dxf")
    document = drawing_of(answer)
    assert document.dxfversion == "AC1021" and document.header["$INSUNITS"] == 4
    colors = {layer.dxf.name: layer.rgb for layer in document.layers}
    assert colors["Schäden 損傷 - Riß_ tief_breit"] == (255, 0, 0), colors
    assert colors["Schäden 損傷 - Salt"] == (0, 0, 255), colors
    quantities = {
        each["value"]: each["area_m2"] * 1e6
        for each in server.ok("GET", f"{M}/layers/marks/quantities").json()["quantities"]
        if each.get("value")
    }
    areas, kinds = {}, {}
    for entity in document.modelspace():
        known = attributes_of(entity)
        assert known["layer"] == "Schäden 損傷", known
        kinds.setdefault(known["value"], set()).add(entity.dxftype())
        if entity.dxftype() != "LWPOLYLINE":
            continue
        assert entity.closed
        ring = numpy.array([point[:2] for point in entity.get_points("xy")])
        assert ring.min() > -1 and ring.max() < 101  # millimeters on the object
        if known["value"] == 3:  # y points up
            assert abs(ring.min(axis=0) - (80, 60)).max() < 0.3, ring
        areas.setdefault(known["value"], {})[known["area_mm2"]] = areas.get(known["value"], {}).get(
            known["area_mm2"], []
        ) + [abs(area_of(ring))]
    for value in (1, 2, 3):
        assert kinds[value] == {"HATCH", "LWPOLYLINE"}, kinds
        for stated, rings in areas[value].items():
            # the outer ring without the holes
            assert abs(2 * max(rings) - sum(rings) - stated) < 0.1, (stated, rings)
        assert abs(sum(areas[value]) - quantities[value]) < 0.01 * quantities[value] + 4, (
            value,
            areas[value],
            quantities,
        )
    hatch = next(
        each for each in document.modelspace().query("HATCH") if each.dxf.layer.endswith("Soot")
    )
    assert not hatch.dxf.solid_fill and hatch.pattern.lines[0].angle == 30
    assert abs(abs(hatch.pattern.lines[0].offset) - 7 * 0.254 * 2.5) < 0.01


def test_refusals(server):
    for wish, field in (
        ({"areas": "outlines", "format": "png"}, "areas"),
        ({"areas": "outlines", "format": "tiff"}, "areas"),
        ({"areas": "outlines", "rollout": {}}, "areas"),
        ({"format": "dxf", "rollout": {}}, "format"),
        ({"tolerance_mm": 0.2}, "tolerance_mm"),
        ({"areas": "outlines", "tolerance_mm": 0.01}, "tolerance_mm"),
        ({"areas": "curves"}, "areas"),
    ):
        answer = server.request("POST", f"{M}/figures", wish)
        assert answer.status in (400, 422) and answer.json().get("field") == field, (wish, answer)


def test_the_log_is_clean(server):
    server.assert_clean_log()
