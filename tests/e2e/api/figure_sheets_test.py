"""What a sheet of figures has besides the drawing: a title block with texts of the model, the
project and the request. In all file formats it is in the same place."""
import datetime
import os
import re
import subprocess
import tempfile
import xml.etree.ElementTree as xml

import numpy
import pytest
from support import tiff
from support.meshes import folded_grid
from support.pictures import pixels

M = "/models/sheet"  # a flat sheet with x and y from 0 to 100 mm
SVG = "{http://www.w3.org/2000/svg}"
PLAIN = {"direction": "top", "dpi": 100, "light": {"mode": "unlit"}, "looks": []}


def figure(server, expect=200, token=True, **wish):
    answer = server.request("POST", f"{M}/figures", {**PLAIN, **wish}, token=token)
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
    for expected in ("Museum of Everything", "Sheet (1884.7)", "Draft", "1 : 1", "Checked by"):
        assert expected in words, (expected, words)
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
