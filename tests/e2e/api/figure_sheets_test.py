"""Sheets of figures: a title block with texts of the model, the project and the request, in the same
place in all file formats, several views with one scale and one legend, and dimensions."""
import datetime
import io
import math
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree as xml

import ezdxf
import numpy
import pytest
from support import tiff
from support.meshes import bumpy_ball, folded_grid
from support.pictures import pixels

M = "/models/sheet"  # a flat sheet with x and y from 0 to 100 mm
SVG = "{http://www.w3.org/2000/svg}"
PLAIN = {"direction": "top", "dpi": 100, "light": {"mode": "unlit"}, "looks": []}


def figure(server, expect=200, token=True, **wish):
    wish = {name: value for name, value in {**PLAIN, **wish}.items() if value is not None}
    answer = server.request("POST", f"{M}/figures", wish, token=token)
    assert answer.status == expect, (wish, answer)
    return answer


def group_of(svg, name):
    """Returns the content of an SVG group: paths as rows of x and y in millimeters on paper, and
    texts. Returns None if there is no such group."""
    group = next(
        (each for each in xml.fromstring(svg).iter(SVG + "g") if each.get("id") == name), None
    )
    if group is None:
        return None
    paths = [
        numpy.array(re.findall(r"-?[\d.]+(?:e-?\d+)?", each.get("d")), float).reshape(-1, 2)
        for each in group.iter(SVG + "path")
    ]
    return paths, [each.text for each in group.iter(SVG + "text")]


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(cells=10, fold=0.0), "sheet.ply", name="Sheet", unit="mm")
    server.ok(
        "PATCH",
        M,
        {"inventory_number": "1884.7", "owner": "Museum of Everything", "credit": "Photo: nobody"},
    )
    return server


def fields_of(svg):
    """Returns the texts of the title block by the names of their fields."""
    texts = group_of(svg, "title-block")[1]
    names = ["Organization", "Project", "Object", "Title", "Status", "Document number"]
    names += ["Author", "Checked by", "Date", "Scale", "Sheet"]
    assert [each for each in texts if each in names] == names, texts
    fields = {}
    for each in texts:
        if each in names and each not in fields:
            name = each
            fields[name] = ""
        else:
            fields[name] += ("\n" if fields[name] else "") + each
    return fields


def test_fields(server):
    """A field without a text in the request has the text of the model, its project or the user. An
    empty text leaves it empty."""
    before = datetime.datetime.now(datetime.timezone.utc).date()
    svg = figure(server, format="svg", scale=2, orientation="portrait", title_block={}).body
    fields = fields_of(svg)
    today = fields.pop("Date")
    after = datetime.datetime.now(datetime.timezone.utc).date()
    assert today in (before.isoformat(), after.isoformat())
    project = server.get("/projects/default").json()["name"]
    me = server.get("/me").json()
    assert fields == {
        "Organization": "Museum of Everything",
        "Project": project,
        "Object": "Sheet (1884.7)",
        "Title": "",
        "Status": "",
        "Document number": "",
        "Author": me.get("full_name") or me["user"],
        "Checked by": "",
        "Scale": "1 : 2",
        "Sheet": "1/1",
    }
    # the title is in the block only, and the credit remains below the drawing
    assert group_of(svg, "caption")[1] == ["Photo: nobody"]
    own = {
        "organization": "Büro für Bauforschung",
        "project": "",
        "object": "Ψ <1> & 2",
        "author": "Ada Lovelace",
        "checked_by": "Vera",
        "date": "Frühjahr 2026",
        "status": "Draft",
        "number": "A-17/3",
        "sheet": "2/5",
    }
    svg = figure(
        server, format="svg", scale=0.5, orientation="portrait", title="Plan", title_block=own
    ).body
    fields = fields_of(svg)
    assert fields == {
        "Organization": own["organization"],
        "Project": "",
        "Object": own["object"],
        "Title": "Plan",
        "Status": "Draft",
        "Document number": "A-17/3",
        "Author": "Ada Lovelace",
        "Checked by": "Vera",
        "Date": own["date"],
        "Scale": "2 : 1",
        "Sheet": "2/5",
    }
    labels = {"organization": "Organisation", "scale": "Maßstab", "sheet": "Blatt"}
    svg = figure(server, format="svg", title_block={**own, "labels": labels}).body
    texts = group_of(svg, "title-block")[1]
    assert set(labels.values()) <= set(texts) and "Organization" not in texts, texts
    server.ok(
        "POST",
        M + "/views",
        {
            "name": "From above",
            "camera": {
                "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, -50, -500, 1],
                "projection": [0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, -0.001, 0, 0, 0, -1, 1],
                "width": 100,
                "height": 100,
            },
        },
    )
    of_view = server.request(
        "POST", M + "/figures", {"view": "from-above", "format": "svg", "title_block": {}}
    )
    assert of_view.status == 200, of_view
    assert "From above" in group_of(of_view.body, "title-block")[1]


def test_formats(server):
    """The title block is in the same place in all formats. DXF files have none."""
    wish = {"title": "Plan", "title_block": {"status": "Draft"}, "scale": 1}
    paths, _ = group_of(figure(server, format="svg", **wish).body, "title-block")
    corner, end = paths[-1].min(axis=0), paths[-1].max(axis=0)
    frame = group_of(figure(server, format="svg", **wish).body, "sheet-frame")[0][0]
    assert abs(frame.max(axis=0) - end).max() < 1e-6
    rows = tiff.read(figure(server, format="tiff", **wish).body)[0]
    assert (rows == numpy.array(pixels(figure(server, format="png", **wish).body))).all()
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sheet.pdf")
        with open(path, "wb") as out:
            out.write(figure(server, format="pdf", **wish).body)
        words = subprocess.run(
            ["pdftotext", "-layout", path, "-"], capture_output=True, check=True, text=True
        ).stdout
        subprocess.run(
            ["pdftoppm", "-r", "100", "-png", "-singlefile", path, path[:-4]], check=True
        )
        with open(path[:-4] + ".png", "rb") as page:
            of_pdf = numpy.array(pixels(page.read()))
    for expected in ("Museum of Everything", "Sheet (1884.7)", "Draft", "1:1", "Checked by"):
        assert expected in words.replace(" : ", ":"), (expected, words)
    for picture in (rows, of_pdf):
        dark = picture.min(axis=2) < 128
        (left, top), (right, bottom) = (
            numpy.round(each / 25.4 * 100).astype(int) for each in (corner, end)
        )
        for line in (
            dark[top - 1 : top + 2, left:right],
            dark[bottom - 1 : bottom + 2, left:right],
        ):
            assert line.any(axis=0).mean() > 0.98
        for line in (
            dark[top:bottom, left - 1 : left + 2],
            dark[top:bottom, right - 1 : right + 2],
        ):
            assert line.any(axis=1).mean() > 0.98
    # a drawing without a title block is larger, and has no frame
    plain = {**wish, "format": "svg"}
    del plain["title_block"]
    svg = figure(server, **plain).body
    assert group_of(svg, "title-block") is None and group_of(svg, "sheet-frame") is None
    assert group_of(svg, "caption")[1][0] == "Plan"
    rollout = {"rollout": {"axis": {"point": [50, 50, -60], "direction": [0, 1, 0]}}}
    answer = server.request(
        "POST", M + "/figures", {**rollout, "format": "svg", "title_block": {}, "dpi": 60}
    )
    assert answer.status == 200 and group_of(answer.body, "title-block"), answer


def boxes_of(svg):
    """Returns the boxes of the views: left, top, right and bottom in millimeters on paper."""
    return [(*each.min(axis=0), *each.max(axis=0)) for each in group_of(svg, "frame")[0]]


def pixels_in(rows, box, dpi):
    left, top, right, bottom = (round(each / 25.4 * dpi) for each in box)
    return rows[top + 1 : bottom - 1, left + 1 : right - 1]


def middles(rows, color):
    """Returns the middle of the pixels of a color on the left and on the right half, in pixels."""
    y, x = numpy.nonzero((abs(rows.astype(int) - color) < 60).all(axis=2))
    left = x < (x.min() + x.max()) / 2
    return numpy.array([[x[half].mean(), y[half].mean()] for half in (left, ~left)])


@pytest.fixture(scope="module")
def ball(server):
    """A ball with two discs at y = −15 mm and y = 15 mm, on its right and on its left side. The disc
    at 15 mm is larger. Class 2 is only on its back."""
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    points = [
        {"at": at, "color": color, "label": label}
        for at, color, label in ((1, "#ff0000", "Disc"), (2, "#0000ff", "Back"))
    ]
    server.ok(
        "POST",
        "/models/ball/layers",
        {
            "name": "Marks",
            "type": "u8",
            "resolution": 2048,
            "palette": {"mode": "categorical", "points": points},
        },
    )
    for where, value in (
        ("abs(x) > 1 and (y + 15) * (y + 15) + z * z < 4", 1),
        ("abs(x) > 1 and (y - 15) * (y - 15) + z * z < 16", 1),
        ("y > 0 and x * x + z * z < 16", 2),
    ):
        server.ok(
            "POST",
            "/models/ball/layers/marks/edits",
            {"op": "fill", "mode": "where", "where": where, "value": value},
        )


def of_ball(server, expect=200, **wish):
    wish = {"dpi": 100, "light": {"mode": "unlit"}, "looks": [], **wish}
    answer = server.request("POST", "/models/ball/figures", wish)
    assert answer.status == expect, (wish, answer)
    return answer


def test_views_are_to_scale(server, ball):
    """Each view has the common scale or its own scale, in pixels and in the text below it."""
    views = [{"direction": "right", "title": "Right"}, {"direction": "left", "title": "Left"}]
    views += [{"direction": "front", "title": "Front"}, {"direction": "back", "title": "Back"}]
    for paper, orientation, own in (
        ("a4", "portrait", None),
        ("a4", "landscape", None),
        ("a3", "landscape", 4),
        ("a5", "portrait", 0.8),
    ):
        wish = {"paper": paper, "orientation": orientation, "views": [dict(each) for each in views]}
        if own:
            wish["views"][1]["scale"] = own
        svg = of_ball(server, format="svg", **wish)
        boxes = boxes_of(svg.body)
        assert len(boxes) == 4
        texts = [group_of(svg.body, f"view-{i}")[1] for i in range(1, 5)]
        assert [each[0] for each in texts] == ["Right", "Left", "Front", "Back"]
        if own:
            bars = [group_of(svg.body, f"scale-bar-{i}") for i in range(1, 5)]
            assert all(bars) and group_of(svg.body, "scale-bar") is None
            scales = [bar[1][-1] for bar in bars]
            assert scales[1] == (f"1 : {own}" if own > 1 else "1.25 : 1")
            assert "ball-views.svg" in svg.headers["Content-Disposition"]
        else:
            assert group_of(svg.body, "scale-bar-1") is None
            scales = [each[1] for each in texts]
            assert group_of(svg.body, "scale-bar")[1][-1] == scales[0]
            assert re.search(r"ball-views-1-[\d.]+\.svg", svg.headers["Content-Disposition"])
        assert len({each for i, each in enumerate(scales) if i != 1 or not own}) == 1
        rows = tiff.read(of_ball(server, format="tiff", **wish).body)[0]
        for i, to_right in ((0, 1), (1, -1)):
            part = pixels_in(rows, boxes[i], 100)
            n, m = (float(each) for each in scales[i].split(" : "))
            found = middles(part, (255, 0, 0))
            apart = (found[1] - found[0])[0] / 100 * 25.4 * m / n
            assert abs(apart - 30) < 0.3 * m / n + 0.2, (wish, i, apart)
            y, x = numpy.nonzero((abs(part.astype(int) - (255, 0, 0)) < 60).all(axis=2))
            larger = (x > part.shape[1] / 2).mean() > 0.5
            assert larger == (to_right > 0), (i, larger)
        # the back has the only blue disc
        blue = [
            (abs(pixels_in(rows, box, 100).astype(int) - (0, 0, 255)) < 60).all(axis=2).sum()
            for box in boxes
        ]
        assert blue[3] > 20 and blue[2] == 0, blue
        # one legend for all views
        assert group_of(svg.body, "legend")[1] == ["Marks", "Disc", "Back"]
        # the space between the views is white
        inside = numpy.zeros(rows.shape[:2], bool)
        for left, top, right, bottom in (numpy.array(box) / 25.4 * 100 for box in boxes):
            inside[int(top) : int(bottom) + 2, int(left) : int(right) + 2] = True
        low = int(boxes[0][0] / 25.4 * 100)
        between = (slice(0, int(boxes[0][3] / 25.4 * 100)), slice(low, None))
        colored = numpy.ptp(rows[between].astype(int), axis=2) > 40
        legend = int(max(box[2] for box in boxes) / 25.4 * 100) + 2
        assert not (colored & ~inside[between])[:, : legend - low].any()


def test_views_of_a_sheet(server, ball):
    """Views can be saved views with their own layers, rollouts and outlines, with a title block."""
    for name, visible in (("With marks", True), ("Without", False)):
        server.ok(
            "POST",
            "/models/ball/views",
            {
                "name": name,
                "camera": {
                    "view": [1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, -500, 1],
                    "projection": [0.02, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, -0.001, 0, 0, 0, -1, 1],
                    "width": 100,
                    "height": 100,
                },
                "layers": [{"layer": "marks", "visible": visible}],
                "looks": [],
                "light": {"mode": "unlit"},
            },
        )
    axis = {"axis": {"point": [0, 0, 0], "direction": [0, 0, 1]}}
    wish = {
        "format": "svg",
        "areas": "outlines",
        "title_block": {},
        "views": [
            {"view": "with-marks"},
            {"view": "without", "title": "Bare"},
            {"direction": "right"},
            {"rollout": axis, "scale": 4},
            {"normal": [1, 1, 0], "center": [0, 0, 0]},
        ],
    }
    answer = server.request("POST", "/models/ball/figures", {**wish, "dpi": 60})
    assert answer.status == 200, answer
    svg = answer.body
    ids = [each.get("id") for each in xml.fromstring(svg).iter() if each.get("id")]
    assert len(ids) == len(set(ids)), "ids of views differ"
    assert {"areas-marks-view-3", "areas-marks-view-5"} <= set(ids), ids
    assert not {"areas-marks-view-2", "areas-marks-view-4"} & set(ids), ids
    titles = [group_of(svg, f"view-{i}") for i in range(1, 6)]
    assert [each and each[1] for each in titles] == [["With marks"], ["Bare"], None, None, None]
    assert any("angles" in each or "degrees" in each or "ruler" in each for each in ids), ids
    scale = group_of(svg, "title-block")[1]
    assert any(re.fullmatch(r"1 : [\d.]+, 1 : 4", each) for each in scale), scale
    # outlines are clipped at the boxes of their views
    boxes = boxes_of(svg)
    rects = [
        each
        for clip in xml.fromstring(svg).iter(SVG + "clipPath")
        if clip.get("id").startswith("drawing-clip")
        for each in clip
    ]
    clips = [[float(each.get(name)) for name in ("x", "y")] for each in rects]
    assert len(clips) >= 2
    for corner in clips:
        assert min(numpy.abs(numpy.subtract(box[:2], corner)).max() for box in boxes) < 0.01
    # all formats have the same size
    for kind in ("pdf", "png", "tiff"):
        more = {**wish, "format": kind, "dpi": 60}
        if kind != "pdf":
            del more["areas"]
        answer = server.request("POST", "/models/ball/figures", more)
        assert answer.status == 200 and len(answer.body) > 1000, answer


def length_in_mm(text):
    number, unit = text.split()
    return float(number) * {"mm": 1, "cm": 10, "m": 1000}[unit]


def test_dimensions_measure_the_drawing(server):
    """The text of a dimension is the length on the drawing plane, and its line has this length to
    scale."""
    corners = {"a": [0, 0, 0], "b": [100, 0, 0], "c": [100, 60, 0], "d": [20, 30, 0]}
    for direction, scale in (("top", 1), ("top", 2.5), ("bottom", 1), ("front", 1)):
        for start, end in ("ab", "bc", "ad", "da", "ac"):
            x, y, z = numpy.subtract(corners[end], corners[start])
            across, up = {"top": (x, y), "bottom": (x, -y), "front": (x, z)}[direction]
            for kind, length in (
                ("aligned", numpy.hypot(across, up)),
                ("horizontal", abs(across)),
                ("vertical", abs(up)),
            ):
                line = {"from": corners[start], "to": corners[end], "direction": kind}
                svg = figure(
                    server,
                    format="svg",
                    dpi=50,
                    direction=direction,
                    scale=scale,
                    dimensions=[line],
                ).body
                found = group_of(svg, "dimensions")
                if length < 0.5:
                    assert found is None
                    continue
                paths, texts = found
                assert abs(length_in_mm(texts[0]) - length) < 1e-3 * length, (line, texts)
                of_line = paths[-3]  # before the two ticks
                assert abs(numpy.hypot(*(of_line[1] - of_line[0])) * scale - length) < 0.01


def test_dimensions_in_all_formats(server):
    lines = [
        {"from": [0, 0, 0], "to": [100, 0, 0]},
        {"from": [100, 0, 0], "to": [100, 100, 0], "direction": "vertical"},
        {"from": [0, 0, 0], "to": [50, 50, 0]},
    ]
    wish = {"dimensions": lines, "scale": 2, "title": ""}
    texts = ["10 cm", "10 cm", "70.71 mm"]
    svg = figure(server, format="svg", **wish).body
    paths, words = group_of(svg, "dimensions")
    assert words == texts
    root = xml.fromstring(svg)
    group = next(each for each in root.iter(SVG + "g") if each.get("id") == "dimensions")
    turns = [
        float(re.match(r"rotate\(([-\d.e]+)", each.get("transform", "rotate(0")).group(1))
        for each in group.iter(SVG + "text")
    ]
    assert turns == [0, -90, -45], turns
    pdf = figure(server, format="pdf", **wish).body
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sheet.pdf")
        with open(path, "wb") as out:
            out.write(pdf)
        told = subprocess.run(["pdftotext", path, "-"], capture_output=True, check=True, text=True)
        subprocess.run(
            ["pdftoppm", "-r", "100", "-png", "-singlefile", path, path[:-4]], check=True
        )
        with open(path[:-4] + ".png", "rb") as page:
            of_pdf = numpy.array(pixels(page.read()))
    # pdftotext splits text at 45° into letters
    assert told.stdout.count("10 cm") >= 2, told.stdout
    # in pixels, the line is where it is in the SVG file
    rows = tiff.read(figure(server, format="tiff", **wish).body)[0]
    begin, end = paths[2] / 25.4 * 100
    for picture in (rows, of_pdf):
        for share in (0.2, 0.35, 0.8):
            x, y = numpy.floor(begin + (end - begin) * share).astype(int)
            around = picture[y - 2 : y + 3, x].astype(int)
            assert around.min() < 140, (share, around)
    # in DXF files, the lines are in millimeters on the object
    drawing = figure(server, format="dxf", **wish).body.decode()
    document = ezdxf.read(io.StringIO(drawing))
    assert not document.audit().errors
    found = [each for each in document.modelspace() if each.dxf.layer == "Dimensions"]
    assert [each.dxf.text for each in found if each.dxftype() == "TEXT"] == texts
    assert [each.dxf.rotation for each in found if each.dxftype() == "TEXT"] == [0, 90, 45]
    lengths = []
    for each in found:
        if each.dxftype() == "LWPOLYLINE":
            (x0, y0), (x1, y1) = each.get_points("xy")
            lengths.append(round(math.hypot(x1 - x0, y1 - y0), 1))
    assert lengths.count(100.0) == 2 and lengths.count(70.7) == 1, lengths
    # views have their own dimensions
    views = [{"direction": "top", "dimensions": lines[:1]}, {"direction": "front"}]
    svg = figure(server, format="svg", direction=None, views=views).body
    assert group_of(svg, "dimensions")[1] == ["10 cm"]


def test_refusals_of_dimensions(server):
    line = {"from": [0, 0, 0], "to": [1, 0, 0]}
    for wish, field in (
        ({"dimensions": [line, {**line, "to": [0, 0, 0]}]}, "dimensions[1].to"),
        ({"dimensions": [{"from": [0, 0, 0]}]}, "dimensions[0].to"),
        ({"dimensions": [{**line, "to": [0, 0]}]}, "dimensions[0].to"),
        ({"dimensions": [{**line, "from": [0, 0, -1e300]}]}, "dimensions[0].from[2]"),
        ({"dimensions": [{**line, "direction": "up"}]}, "dimensions[0].direction"),
        ({"dimensions": [line] * 101}, "dimensions"),
        ({"dimensions": [line], "rollout": {}, "direction": None, "light": None}, "dimensions"),
        ({"dimensions": [line], "views": [{}, {}], "direction": None}, "dimensions"),
        (
            {"views": [{}, {"dimensions": [{**line, "to": [0, 0, 0]}]}], "direction": None},
            "views[1].dimensions[0].to",
        ),
    ):
        problem = figure(server, 422, **wish).json()
        assert problem["detail"] and problem.get("field") == field, (wish, problem)
    far = {"from": [-1e9, 0, 0], "to": [1e9, 5, 0]}
    assert b"dimensions" in figure(server, format="svg", scale=1, dimensions=[far]).body


def test_refusals_of_views(server, ball):
    two = [{"direction": "top"}, {"direction": "front"}]
    for wish, field in (
        ({"views": two[:1]}, "views"),
        ({"views": two * 4}, "views"),
        ({"views": [{"direction": "north"}, {}]}, "views[0].direction"),
        ({"views": [{}, {"view": "nothing"}]}, "views[1].view"),
        ({"views": [{}, {"normal": [0, 0, 0]}]}, "views[1].normal"),
        ({"views": [{}, {"direction": "top", "normal": [0, 0, 1]}]}, "views[1].normal"),
        ({"views": [{}, {"direction": "top", "rollout": {}}]}, "views[1].direction"),
        ({"views": [{}, {"rollout": {}}]}, "views[1].rollout.axis"),
        ({"views": [{}, {"title": "x" * 201}]}, "views[1].title"),
        ({"views": [{}, {"scale": 0}]}, "views[1].scale"),
        ({"views": [{}, {"nothing": 1}]}, None),
        ({"views": two, "direction": "top"}, "direction"),
        ({"views": two, "normal": [0, 0, 1]}, "normal"),
        ({"views": two, "center": [0, 0, 1]}, "center"),
        ({"views": two, "rollout": {}}, "rollout"),
        ({"views": two, "format": "dxf"}, "format"),
    ):
        problem = of_ball(server, 422, **wish).json()
        assert problem["detail"] and (field is None or problem.get("field") == field), (
            wish,
            problem,
        )


def test_refusals(server):
    for block, field in (
        ({"organization": "x" * 201}, "title_block.organization"),
        ({"sheet": "x" * 31}, "title_block.sheet"),
        ({"author": 3}, "title_block.author"),
        ({"labels": {"scale": "x" * 61}}, "title_block.labels.scale"),
        ({"colour": "red"}, None),
        ([], "title_block"),
    ):
        problem = figure(server, 422, title_block=block).json()
        assert field is None or problem.get("field") == field, (block, problem)
    assert figure(
        server, title_block={name: "m" * 200 for name in ("organization", "project", "object")}
    )


def test_the_log_is_clean(server):
    server.assert_clean_log()
