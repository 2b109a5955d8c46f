"""Measured figures: lengths are to scale on paper, in every direction, file format and resolution.
Parts join without seams. A figure shows one state of the layers. The file also tests jobs,
visibility and refusals."""
import math
import os
import re
import subprocess
import tempfile
import threading
import xml.etree.ElementTree as xml

import numpy
import pytest
from support import tiff
from support.cameras import camera_from
from support.meshes import bumpy_ball, folded_grid
from support.pictures import pixels
from support.strata_server import wait_for

M = "/models/sheet"  # a sheet with x and y from 0 to 100 mm, in folds up to 24 mm high
F = M + "/figures"
PAPER = {"a5": (148, 210), "a4": (210, 297), "a3": (297, 420)}
UNLIT = {"mode": "unlit"}
RED = (255, 0, 0)
MARKS = [{"layer": "marks", "visible": True}]
SVG = "{http://www.w3.org/2000/svg}"
BARE = {"legend": False, "light": UNLIT, "looks": [], "title": "", "credit": ""}


def figure(server, expect=200, token=True, model="sheet", lang="", **wish):
    answer = server.request(
        "POST", f"/models/{model}/figures" + (f"?lang={lang}" if lang else ""), wish, token=token
    )
    assert answer.status == expect, (wish, answer)
    return answer


def drawn(server, token=True, **wish):
    """Returns the sheet's pixels as rows × columns × 3."""
    rows, tags = tiff.read(figure(server, format="tiff", token=token, **wish).body)
    assert tags[296] == (2,) and tags[282] == tags[283] == (wish.get("dpi", 300), 1), tags
    return rows


def spots(rows, color=RED, by=60):
    """Returns the pixels with approximately this color, as x and y of their centers."""
    y, x = numpy.nonzero((abs(rows.astype(int) - color) <= by).all(axis=2))
    return numpy.stack([x, y], axis=1) + 0.5


def middle(found):
    return found.mean(axis=0)


def fill(server, where, value=1, layer="marks", model="sheet"):
    server.ok(
        "POST",
        f"/models/{model}/layers/{layer}/edits",
        {"op": "fill", "mode": "where", "where": where, "value": value},
    )


def dab(server, x, y, value=1, layer="marks", radius=2, model="sheet"):
    """Paints a disc, seen from above, on every surface below it."""
    fill(
        server,
        f"(x - {x}) * (x - {x}) + (y - {y}) * (y - {y}) < {radius * radius}",
        value,
        layer,
        model,
    )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(cells=40), "sheet.ply", name="Sheet", unit="mm")
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Marks",
            "type": "u8",
            "resolution": 2048,
            "palette": {
                "mode": "categorical",
                "points": [{"at": 1, "color": "#ff0000", "label": "One mark"}],
            },
        },
    )
    return server


@pytest.fixture
def folder():
    with tempfile.TemporaryDirectory() as folder:
        yield folder


def test_lengths_are_those_of_the_world(server):
    """Each side of a ball has a small disc at −15 mm and a larger one at 15 mm from its middle.
    Their distance on paper gives the scale, and the disc on the right gives the direction."""
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    server.ok("POST", "/models/ball/layers", {"name": "Marks", "type": "u8", "resolution": 2048})
    sides = {
        "top": ("x", "y", "z > 0", 1),
        "bottom": ("x", "y", "z < 0", 1),
        "front": ("x", "z", "y < 0", 1),
        "back": ("x", "z", "y > 0", -1),
        "right": ("y", "z", "x > 0", 1),
        "left": ("y", "z", "x < 0", -1),
    }
    for value, (direction, (along, across, side, to_right)) in enumerate(sides.items(), 1):
        for place, radius in ((-15, 2), (15, 4)):
            fill(
                server,
                f"{side} and ({along} - {place}) * ({along} - {place}) + {across} * {across} < {radius * radius}",
                value,
                model="ball",
            )
        palette = {"mode": "categorical", "points": [{"at": value, "color": "#ff0000"}]}
        for scale, dpi, paper in (
            (1, 100, "a4"),
            (2, 200, "a5"),
            (0.5, 75, "a3"),
            (2.5, 144, "a4"),
        ):
            rows = drawn(
                server,
                model="ball",
                direction=direction,
                scale=scale,
                dpi=dpi,
                paper=paper,
                layers=[{"layer": "marks", "palette": palette}],
                **BARE,
            )
            assert {*rows.shape[:2]} == {round(side / 25.4 * dpi) for side in PAPER[paper]}, (
                rows.shape,
                paper,
                dpi,
            )
            found = spots(rows)
            left = found[:, 0] < (found[:, 0].min() + found[:, 0].max()) / 2
            apart = (middle(found[~left]) - middle(found[left]))[0] / dpi * 25.4 * scale
            assert abs(apart - 30) < 25.4 / dpi * scale * 0.6 + 0.1, (direction, scale, dpi, apart)
            assert ((~left).sum() > left.sum()) == (to_right > 0), (
                direction,
                left.sum(),
                (~left).sum(),
            )
    dab(server, 20, 50)
    plan = spots(drawn(server, direction="top", scale=1, dpi=100, layers=MARKS, **BARE))
    dab(server, 50, 90)  # y points up on the paper
    assert (
        middle(spots(drawn(server, direction="top", scale=1, dpi=100, layers=MARKS, **BARE)))[1]
        < middle(plan)[1] - 20
    )


def group_of(svg, name):
    """Returns the content of the SVG group with this id: paths as rows of x and y in millimeters on
    paper, and words."""
    group = next(each for each in xml.fromstring(svg).iter(SVG + "g") if each.get("id") == name)
    paths = [
        numpy.array(re.findall(r"-?[\d.]+(?:e-?\d+)?", each.get("d")), float).reshape(-1, 2)
        for each in group.iter(SVG + "path")
    ]
    return paths, [each.text for each in group.iter(SVG + "text")]


def test_bars(server):
    """The length of the scale bar on paper, in vectors and in pixels, agrees with its label. The
    test uses scales from 5 : 1 for a find of a few centimeters to 1 : 500 for a site."""
    site = {
        "model": "site",
        "direction": "top",
        "paper": "a3",
        "orientation": "landscape",
        "layers": MARKS,
        **BARE,
    }
    server.import_model(folded_grid(), "site.ply", name="Site", unit="m")
    server.ok(
        "POST",
        "/models/site/layers",
        {
            "name": "Marks",
            "type": "u8",
            "resolution": 2048,
            "palette": {"mode": "categorical", "points": [{"at": 1, "color": "#ff0000"}]},
        },
    )
    for x, radius in ((20, 2), (80, 4)):
        dab(server, x, 50, radius=radius, model="site")
    for scale in (500, 350):
        found = spots(drawn(server, dpi=100, scale=scale, **site))
        left = found[:, 0] < (found[:, 0].min() + found[:, 0].max()) / 2
        apart = (middle(found[~left]) - middle(found[left]))[0] / 100 * 25.4 * scale / 1000
        assert abs(apart - 60) < 0.00025 * scale, (scale, apart)
    for scale, dpi, asked in (
        (500, 300, site),
        (350, 150, site),
        (1, 300, {"direction": "top"}),
        (0.2, 150, {"direction": "top", "paper": "a5"}),
        (2.5, 300, {"direction": "front"}),
    ):
        steps, words = group_of(
            figure(server, format="svg", scale=scale, dpi=50, **asked).body, "scale-bar"
        )
        ends = numpy.concatenate(steps)
        low, high = ends.min(axis=0), ends.max(axis=0)
        number, unit = words[len(steps)].split()
        world_mm = float(number) * {"mm": 1, "cm": 10, "m": 1000, "km": 1e6}[unit]
        assert abs((high - low)[0] * scale - world_mm) < 1e-3 * world_mm, (scale, low, high, words)
        assert [float(each) for each in words[: len(steps)]] == [
            float(number) * i / len(steps) for i in range(len(steps))
        ], words
        # the pixels give the same length, including the outline
        per_mm = dpi / 25.4
        row = (
            drawn(server, dpi=dpi, scale=scale, **asked)[
                round((low[1] + high[1]) / 2 * per_mm)
            ].mean(axis=1)
            < 128
        )
        dark = numpy.nonzero(row[round((low[0] - 1) * per_mm) : round((high[0] + 1) * per_mm)])[0]
        assert abs(dark.max() + 1 - dark.min() - world_mm / scale * per_mm) < 0.2 * per_mm + 1.5, (
            scale,
            dpi,
            dark.min(),
            dark.max(),
        )


def test_north(server):
    """The arrow points north for each up axis, from above and from below."""
    palette = {
        "mode": "categorical",
        "points": [{"at": 11, "color": "#ff0000"}, {"at": 12, "color": "#00ff00"}],
    }
    asked = {
        "model": "ball",
        "scale": 1,
        "dpi": 100,
        "layers": [{"layer": "marks", "palette": palette}],
        **BARE,
    }
    for up, (east, ahead, height), direction, degrees in (
        ("z", "xyz", "top", 0),
        ("z", "xyz", "top", 30),
        ("z", "xyz", "bottom", -100),
        ("y", "xzy", "top", 200),
        ("x", "yzx", "top", 75),
    ):
        server.ok("PATCH", "/models/ball", {"up": up, "north": str(degrees)})
        fill(server, "true", 0, model="ball")
        turn = math.radians(degrees)
        sign = -1 if up == "y" else 1  # with y up and a view along -z, north points into the image
        for value, away in ((11, 0), (12, 25)):
            fill(
                server,
                f"{height} {'>' if direction == 'top' else '<'} 0 and ({east} - {away * math.sin(turn)}) * ({east} - {away * math.sin(turn)}) + "
                f"({ahead} - {sign * away * math.cos(turn)}) * ({ahead} - {sign * away * math.cos(turn)}) < 9",
                value,
                model="ball",
            )
        rows = drawn(server, direction=direction, **asked)
        to_north = middle(spots(rows, (0, 255, 0))) - middle(spots(rows))
        arrow, words = group_of(
            figure(server, format="svg", direction=direction, **asked).body, "north"
        )
        tip, _, notch = arrow[0]
        assert words == ["N"]
        off = (math.degrees(math.atan2(*to_north) - math.atan2(*(tip - notch))) + 180) % 360 - 180
        assert abs(off) < 1.5, (up, direction, degrees, off)


def test_parts_join_without_seams(server):
    """A3 at 600 dpi is the largest drawing. It is made of parts of three inches, and equals the
    drawing with fewer parts."""
    asked = {
        "direction": "top",
        "scale": 0.35,
        "paper": "a3",
        "orientation": "landscape",
        "layers": MARKS,
        **BARE,
    }
    fine, coarse = drawn(server, dpi=600, **asked), drawn(server, dpi=100, **asked).astype(int)
    assert fine.shape == (7016, 9921, 3), fine.shape
    rows, columns = coarse.shape[0] - 2, coarse.shape[1] - 2
    means = (
        fine[: 6 * rows, : 6 * columns].reshape(rows, 6, columns, 6, 3).mean(axis=(1, 3))[1:, 1:]
    )
    around = numpy.stack(
        [
            coarse[1 + dy : rows + dy, 1 + dx : columns + dx]
            for dy in (-1, 0, 1)
            for dx in (-1, 0, 1)
        ]
    )
    differs = ((means < around.min(axis=0) - 12) | (means > around.max(axis=0) + 12)).any(axis=2)
    in_frame = differs[45:700, 45:1115]
    assert in_frame.mean() < 0.0005, in_frame.mean()
    # at the borders of parts, the surface is as smooth as elsewhere
    corner, part = round(10 / 25.4 * 600), 3 * 600
    for axis, low, high in ((0, 300, 4100), (1, 1500, 5500)):  # ranges that contain only surface
        steps = abs(numpy.diff(fine[300:4100, 1500:5500].sum(axis=2), axis=axis)).mean(
            axis=1 - axis
        )
        borders = [at - low - 1 for at in range(corner, high, part) if at > low]
        assert len(borders) >= 2 and steps[borders].max() <= numpy.delete(steps, borders).max(), (
            axis,
            steps[borders],
            steps.max(),
        )


def test_kinds(server, folder):
    wish = {
        "direction": "top",
        "dpi": 150,
        "caption": "Of <2024> & later — Ψ",
        "credit": "Museum",
        "title": "Sheet 7",
    }
    pdf = figure(server, format="pdf", **wish)
    assert pdf.headers["Content-Type"] == "application/pdf" and pdf.body[:5] == b"%PDF-"
    assert re.fullmatch(
        r"attachment; filename\*=UTF-8''sheet-top-1-1\.pdf", pdf.headers["Content-Disposition"]
    ), pdf.headers
    assert int(pdf.headers["Strata-Sequence"]) == int(pdf.headers["Strata-Durable-Sequence"])
    path = os.path.join(folder, "sheet.pdf")
    with open(path, "wb") as out:
        out.write(pdf.body)
    words = subprocess.run(
        ["pdftotext", "-layout", path, "-"], capture_output=True, check=True, text=True
    ).stdout
    for expected in ("Sheet 7", "Of <2024> & later — Ψ", "Museum", "1:1", "Marks", "One mark"):
        assert expected in words.replace(" : ", ":"), (expected, words)
    facts = subprocess.run(["pdfinfo", path], capture_output=True, check=True, text=True).stdout
    assert re.search(
        r"Page size:\s+(595\.\d+ x 841\.\d+|841\.\d+ x 595\.\d+) pts \(A4\)", facts
    ) and re.search(r"Pages:\s+1\n", facts), facts
    # the PDF draws at the same positions as the TIFF
    bare = {"direction": "top", "dpi": 72, **BARE}
    with open(path, "wb") as out:
        out.write(figure(server, format="pdf", **bare).body)
    subprocess.run(["pdftoppm", "-r", "72", "-png", "-singlefile", path, path[:-4]], check=True)
    with open(path[:-4] + ".png", "rb") as of_page:
        of_pdf, of_tiff = numpy.array(pixels(of_page.read())), drawn(server, **bare)
    assert abs(numpy.array(of_pdf.shape) - of_tiff.shape).max() <= 1, (of_pdf.shape, of_tiff.shape)
    ends = [[spots(rows).min(axis=0), spots(rows).max(axis=0)] for rows in (of_pdf, of_tiff)]
    assert len(spots(of_tiff)) > 50 and abs(numpy.subtract(*ends)).max() <= 2, ends
    coarse = {**wish, "dpi": 50}
    assert (
        numpy.array(pixels(figure(server, format="png", **coarse).body)) == drawn(server, **coarse)
    ).all()

    svg = figure(server, format="svg", **wish).body
    root = xml.fromstring(svg)
    name = lambda tag: SVG + tag
    groups = {each.get("id") for each in root.iter(name("g"))}
    assert {"frame", "legend", "caption", "scale-bar"} <= groups and "north" not in groups, groups
    texts = [each.text for each in root.iter(name("text"))]
    assert "Of <2024> & later — Ψ" in texts and "One mark" in texts, texts
    image = next(root.iter(name("image")))
    assert image.get("href").startswith("data:image/jpeg;base64,") and root.get("width") in (
        "210mm",
        "297mm",
    )

    tags = tiff.read(figure(server, format="tiff", **wish).body)[1]
    assert tags[269] == "Sheet 7" and tags[315] == "Museum", tags

    # the legend lists only layers and classes that are painted
    server.ok("POST", M + "/layers", {"name": "Bare", "type": "u8", "resolution": 2048})
    points = [
        {"at": at, "color": color, "label": label}
        for at, color, label in ((1, "#ff0000", "One mark"), (2, "#00ff00", "Nowhere"))
    ]
    shown = figure(
        server,
        format="svg",
        dpi=50,
        layers=[{"layer": "marks", "palette": {"mode": "categorical", "points": points}}],
    ).body
    assert b">One mark<" in shown and b">Nowhere<" not in shown and b">Bare<" not in shown
    server.ok("DELETE", M + "/layers/bare")

    # a model with a north direction gets an arrow in the plan, and no arrow in an elevation that
    # faces north
    server.ok("PATCH", M, {"north": "30"})
    for direction, shown in (("top", True), ("front", False)):
        groups = {
            each.get("id")
            for each in xml.fromstring(
                figure(server, format="svg", dpi=50, direction=direction).body
            ).iter(name("g"))
        }
        assert ("north" in groups) == shown, (direction, groups)


def test_names(server, story):
    """The figure shows the names of records, including terms, at their positions. It omits private
    names."""
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Units",
            "type": "u16",
            "kind": "database",
            "resolution": 2048,
            "columns": [
                {"name": "Label", "kind": "text"},
                {"name": "Depth", "kind": "numeric", "unit": "cm"},
            ],
        },
    )
    for key, x, y in ((1, 20, 20), (2, 80, 20), (3, 50, 80)):
        server.ok(
            "POST",
            "/tables/units/records",
            {"key": key, "values": {"label": f"Unit {key}", "depth": key * 1.5}},
        )
        dab(server, x, y, key, "units", 8)
    server.ok("POST", "/tables/units/records", {"key": 4, "values": {"label": "nowhere"}})
    wish = {
        "direction": "top",
        "format": "svg",
        "dpi": 60,
        "scale": 1,
        "labels": {"layer": "units", "column": "label"},
    }

    def told(**more):
        group = [
            each
            for each in xml.fromstring(figure(server, **{**wish, **more}).body).iter(SVG + "g")
            if each.get("id") == "labels"
        ]
        return (
            {each.text: (float(each.get("x")), float(each.get("y"))) for each in group[0]}
            if group
            else {}
        )

    at = told()
    assert set(at) == {"Unit 1", "Unit 2", "Unit 3"}, at
    assert (
        abs(at["Unit 2"][0] - at["Unit 1"][0] - 60) < 6
        and abs(at["Unit 1"][1] - at["Unit 3"][1] - 60) < 6
    ), at
    assert set(told(labels={"layer": "units", "column": "depth"})) == {"1.5 cm", "3 cm", "4.5 cm"}
    assert set(told(scale=50)) < set(at), "at 2 mm there is room for one"
    story.labels = wish


def test_views(server):
    """A figure of a saved view shows the view's content with the view's camera."""
    camera = {**camera_from(server.get(M).json(), (0, -1, 0.0)), "section": [[0, 1, 0, -50]]}
    server.ok(
        "POST",
        M + "/views",
        {
            "name": "Cut",
            "camera": camera,
            "light": UNLIT,
            "layers": [{"layer": "marks", "visible": False}],
            "looks": [],
        },
    )
    cut = drawn(server, view="cut", dpi=60, legend=False)
    assert not len(spots(cut))
    name = figure(server, view="cut", dpi=60, format="svg").headers["Content-Disposition"]
    assert name.startswith("attachment; filename*=UTF-8''sheet-cut-1-"), name
    hidden = {"layers": [{"layer": "marks", "visible": False}], "dpi": 60}
    assert (
        cut == drawn(server, camera=camera, light=UNLIT, looks=[], legend=False, **hidden)
    ).all()
    assert (
        drawn(server, normal=[0, -2, 0], **hidden, **BARE)
        == drawn(server, direction="front", **hidden, **BARE)
    ).all()


def test_reviews(server):
    """Pending edits are hatched and listed in the legend until they are accepted."""
    rita, vito = server.add_person("rita", "annotator"), server.add_person("vito", "viewer")
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Finds",
            "type": "u8",
            "resolution": 2048,
            "review": True,
            "palette": {"mode": "categorical", "points": [{"at": 1, "color": "#ff0000"}]},
        },
    )
    edits = M + "/layers/finds/edits"
    wish = {
        "direction": "top",
        "scale": 1,
        "dpi": 100,
        "layers": [{"layer": "marks", "visible": False}],
        **BARE,
    }
    fill(server, "x > 10 and x < 90 and y > 10 and y < 40", layer="finds")
    plain = drawn(server, **wish)
    painted = server.request(
        "POST",
        edits,
        {
            "op": "fill",
            "mode": "where",
            "where": "x > 10 and x < 90 and y > 60 and y < 90",
            "value": 1,
        },
        token=rita,
    )
    assert painted.status == 200 and painted.json()["provisional"], painted
    (left, top), (right, bottom) = (
        spots(plain).min(axis=0).astype(int) + 4,
        spots(plain).max(axis=0).astype(int) - 4,
    )
    up = round(50 / 25.4 * 100)  # from the accepted to the pending area

    def inks(rows, above):
        part = rows[top - above : bottom - above, left:right].astype(int)
        return [(abs(part - color).max(axis=2) < 60).mean() for color in (RED, (24, 24, 24))]

    rows = drawn(server, token=vito, **wish)
    assert inks(rows, 0) == [1, 0], inks(rows, 0)
    red, dark = inks(rows, up)
    # the lines have no tint, so the color below does not change
    assert 0.3 < red < 0.8 and 0.1 < dark < 0.5, (red, dark)
    words = lambda **more: group_of(
        figure(server, format="svg", **{**wish, "legend": True, **more}).body, "legend"
    )[1]
    assert (
        words().count("Provisional") == 1 and words(provisional="Vorläufig").count("Vorläufig") == 1
    ), words()
    assert "Provisional" not in words(layers=[{"layer": "finds", "visible": False}])
    # at an earlier sequence, the figure shows only accepted edits
    sequence = painted.json()["sequence"]
    assert "Provisional" not in words(at=sequence) and inks(
        drawn(server, at=sequence, **wish), up
    ) == [1, 0]
    server.ok("PATCH", M + "/layers/finds", {"visibility": "private"})
    assert (
        b"Provisional"
        not in figure(server, token=vito, format="svg", **{**wish, "legend": True}).body
    )
    server.ok("POST", M + "/layers/finds/review", {"decision": "accept", "all": True})
    assert (
        "Provisional" not in words()
        and (drawn(server, **wish) == drawn(server, at=sequence, **wish)).all()
    )
    # after a whole layer was erased, only the pending class remains
    server.ok("PATCH", M + "/layers/finds", {"visibility": "public"})
    erased = server.request(
        "POST", edits, {"op": "fill", "mode": "where", "where": "true", "erase": True}, token=rita
    )
    assert erased.status == 200 and words()[:2] == ["Finds", "Provisional"], (erased, words())
    for wrong in ("", "x" * 101, 3):
        assert figure(server, expect=422, provisional=wrong).json()["field"] == "provisional"
    server.ok("DELETE", M + "/layers/finds")


def test_legends(server):
    """The legend lists only the content of the drawing. It omits layers that an opaque layer covers
    completely, and content outside the drawing. It includes classes that consist only of lines and
    points."""
    for name in ("Low", "High"):
        points = [
            {"at": at, "color": color, "label": f"{name} {at}"}
            for at, color in ((1, "#2040ff"), (2, "#20c040"))
        ]
        server.ok(
            "POST",
            M + "/layers",
            {
                "name": name,
                "type": "u8",
                "resolution": 2048,
                "palette": {"mode": "categorical", "points": points},
            },
        )
    fill(server, "x < 50", 1, "low")
    fill(server, "x > 60", 2, "low")
    fill(server, "x < 55", 1, "high")
    others = [{"layer": layer, "visible": False} for layer in ("marks", "units")]

    def told(high={}, **more):
        wish = {
            "direction": "top",
            "format": "svg",
            "dpi": 50,
            "scale": 1,
            "layers": [*others, {"layer": "high", **high}],
            **more,
        }
        return group_of(figure(server, **wish).body, "legend")[1]

    assert told() == ["High", "High 1", "Low", "Low 2"], told()
    server.ok("PATCH", M + "/layers/high", {"labels": {"de": "Oben"}})
    assert told(lang="de-AT") == ["Oben", "High 1", "Low", "Low 2"], told(lang="de-AT")
    assert told(lang="es")[0] == "High", "it has no name in Spanish"
    figure(server, 422, lang="x" * 36, direction="top")
    assert told({"opacity": 0.5}) == ["High", "High 1", "Low", "Low 1", "Low 2"]
    server.ok("PATCH", M + "/layers/high", {"blend": "multiply"})
    assert told() == ["High", "High 1", "Low", "Low 1", "Low 2"], "multiplied, it hides nothing"
    server.ok("PATCH", M + "/layers/high", {"blend": "normal"})
    assert told({"visible": False}) == ["Low", "Low 1", "Low 2"]
    hatched = {
        "palette": {
            "mode": "categorical",
            "points": [{"at": 1, "color": "#2040ff", "label": "Lines", "pattern": "hatch"}],
        }
    }
    assert told(hatched) == [
        "High",
        "Lines",
        "Low",
        "Low 1",
        "Low 2",
    ], "below a pattern the others are seen"
    assert told(scale=0.1, paper="a5", center=[90, 50, 0]) == [
        "Low",
        "Low 2",
    ], "on 15 mm around its right side"
    # records that have only lines are also classes of the drawing
    table = server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Cracks", "columns": [{"name": "Way", "kind": "line"}]},
    ).json()
    points = [
        {"at": at, "color": "#ff8000", "label": label}
        for at, label in ((1, "Crack"), (2, "Elsewhere"), (3, "Above"))
    ]
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Cracks",
            "kind": "database",
            "type": "u16",
            "table": table["slug"],
            "resolution": 2048,
            "palette": {"mode": "categorical", "points": points},
        },
    )
    model = server.get(M).json()["id"]
    way = [{"model": model, "coordinates": [[80, 20, 0], [80, 80, 0]]}]
    above = [{"model": model, "coordinates": [[20, 20, 40], [20, 80, 40]]}]
    for key, values in ((1, {"way": way}), (2, {}), (3, {"way": above})):
        server.ok("POST", "/tables/cracks/records", {"key": key, "values": values})
    assert told() == [
        "Cracks",
        "Crack",
        "Above",
        "High",
        "High 1",
        "Low",
        "Low 2",
    ], "what hangs before the surface is drawn"
    assert "Above" not in told(direction="bottom"), "what lies behind it is not"
    # a long list continues in the next column, below its repeated title
    points = [{"at": at, "color": "#2040ff", "label": f"Class {at}"} for at in range(1, 61)]
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Many",
            "type": "u8",
            "resolution": 2048,
            "palette": {"mode": "categorical", "points": points},
        },
    )
    for at in range(1, 61):
        fill(server, f"x > {at * 1.5} and y > 3", at, "many")
    words = told(continued="(weiter)", paper="a3", orientation="portrait")
    assert words.count("Many (weiter)") >= 1 and all(
        f"Class {at}" in words for at in range(1, 61)
    ), words
    for name in ("low", "high", "cracks", "many"):
        server.ok("DELETE", f"{M}/layers/{name}")


def test_states_and_jobs(server, story):
    """A figure can show an earlier time. Edits cannot change a figure while it is drawn. Only some
    users can get and cancel jobs and their files."""
    labels = story.labels
    viewer, other = server.add_person("vera", "viewer"), server.add_person("ada", "annotator")
    before = server.get(M).json()["sequence"]
    wish = {"direction": "top", "dpi": 100, "format": "png", "layers": MARKS, **BARE}
    then = figure(server, **wish).body
    dab(server, 20, 80)
    assert figure(server, at=before, **wish).body == then != figure(server, **wish).body
    assert figure(server, token=viewer, at=before, **wish).body == then

    started = server.request(
        "POST",
        F,
        {**wish, "at": before},
        headers={"Prefer": "respond-async, wait=10"},
        token=viewer,
    )
    assert (
        started.status == 202 and started.headers["Preference-Applied"] == "respond-async"
    ), started
    job = f"/jobs/{started.json()['id']}"
    assert started.headers["Location"] == "/api/v1" + job
    wait_for(
        lambda: server.request("GET", job, token=viewer).json()["state"]
        not in ("queued", "running"),
        "the figure",
    )
    done = server.request("GET", job, token=viewer).json()
    assert (
        done["state"] == "done"
        and done["file"]["name"] == "sheet-top-1-1.png"
        and done["file"]["media_type"] == "image/png"
    ), done
    file = server.request("GET", job + "/file", token=viewer)
    assert file.status == 200 and file.body == then and len(then) == done["file"]["bytes"]
    for who in (other, True):  # the figure belongs to the viewer
        assert "file" not in server.request("GET", job, token=who).json()
        assert server.request("GET", job + "/file", token=who).status == 404
    assert server.request("DELETE", job, token=viewer).status == 409

    # only the user who started a long figure can cancel it, and a canceled figure leaves no file
    long = {**wish, "dpi": 600, "paper": "a3", "format": "tiff", "scale": 0.3}
    for who, ends in ((viewer, viewer), (other, True)):
        started = server.request("POST", F, long, headers={"Prefer": "respond-async"}, token=who)
        job = f"/jobs/{started.json()['id']}"
        assert server.request("GET", job + "/file", token=who).status == 409
        assert server.request("DELETE", job, token=viewer if who is other else other).status == 403
        assert server.request("DELETE", job, token=ends).status == 200
        wait_for(
            lambda: server.request("GET", job, token=who).json()["state"] == "cancelled",
            "the end of it",
        )
        assert server.request("GET", job + "/file", token=who).status == 404
    kept = os.listdir(os.path.join(server.data, "uploads"))
    assert sum(each.endswith(".figure") for each in kept) == 1, kept

    # edits are possible while a figure is drawn, and the figure shows none of them
    answers = []
    thread = threading.Thread(
        target=lambda: answers.append(
            figure(server, direction="top", dpi=600, format="png", layers=MARKS, scale=1, **BARE)
        )
    )
    thread.start()
    for n in range(12):
        dab(server, 10 + 6 * n, 10)
    thread.join()
    sequence = int(answers[0].headers["Strata-Sequence"])
    assert (
        figure(
            server,
            at=sequence,
            direction="top",
            dpi=600,
            format="png",
            layers=MARKS,
            scale=1,
            **BARE,
        ).body
        == answers[0].body
    )

    # figures for users who cannot see private content contain no color, legend or label of that
    # content
    server.ok("PATCH", M + "/layers/units", {"visibility": "private"})
    svg = figure(server, token=viewer, format="svg", dpi=60).body
    assert b">Units<" not in svg and b">Marks<" in svg
    figure(server, expect=422, token=viewer, **labels)
    server.ok("PATCH", M + "/layers/units", {"visibility": "public"})
    server.ok("PATCH", "/tables/units/columns/label", {"visibility": "private"})
    assert figure(server, expect=422, token=viewer, **labels).json()["field"] == "labels.column"


def test_refusals(server):
    for wish, field in (
        ({"view": "nothing"}, "view"),
        ({"view": "cut", "light": UNLIT}, "view"),
        ({"direction": "top", "normal": [0, 0, 1]}, "normal"),
        ({"normal": [0, 0, 0]}, "normal"),
        ({"scale": 0}, "scale"),
        ({"scale": 1e9}, "scale"),
        ({"dpi": 1200}, "dpi"),
        ({"dpi": 10}, "dpi"),
        ({"paper": "a0"}, "paper"),
        ({"direction": "north"}, "direction"),
        ({"format": "jpeg"}, "format"),
        ({"layers": [{"layer": "nothing"}]}, "layers[0].layer"),
        ({"looks": [{"look": "x"}]}, "looks[0].look"),
        ({"at": 10**9}, "at"),
        ({"labels": {"layer": "marks", "column": "x"}}, "labels.layer"),
        ({"labels": {"layer": "units", "column": "x"}}, "labels.column"),
        ({"title": "x" * 201}, "title"),
        ({"center": [1, 2]}, "center"),
        ({"nothing": 1}, None),
    ):
        answer = server.request("POST", F, wish)
        assert answer.status in (400, 404, 422) and answer.json()["detail"], (wish, answer)
        assert field is None or answer.json().get("field") == field, (wish, answer)
    gone = {
        "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -500, 1],
        "projection": [0.01, 0, 0, 0, 0, 0.01, 0, 0, 0, 0, -0.001, 0, 0, 0, -1, 1],
        "width": 100,
        "height": 100,
        "section": [[0, 0, 1, -1000]],
    }
    assert figure(server, expect=422, camera=gone).json()["field"] == "camera.section"
    assert server.request("POST", "/models/nothing/figures", {}).status == 404
    assert server.request("POST", F, {}, token=None).status == 401
    assert server.get("/jobs/1/file").status == 404


def test_the_log_is_clean(server):
    server.assert_clean_log()
