"""Condition reports: the document has the object, the drawings at their scale, the quantities of the
layers and the findings with their pictures, in three languages, as DOCX and as PDF. The file also
tests jobs, visibility and refusals."""
import base64
import io
import math
import re
import subprocess
import xml.etree.ElementTree as xml
import zipfile

import pytest
from support.cameras import camera_from
from support.meshes import vessel
from support.pictures import png

M = "/models/column"
W = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
DRAWING = "{http://schemas.openxmlformats.org/drawingml/2006/wordprocessingDrawing}"
DOCX = "application/vnd.openxmlformats-officedocument.wordprocessingml.document"
EMU_PER_MM = 36000
FAST = {"figures": [], "record_pictures": False}


def report(server, expect=200, token=True, **wish):
    answer = server.request("POST", M + "/report", wish, token=token)
    assert answer.status == expect, (wish, answer)
    return answer


def body_of(docx):
    archive = zipfile.ZipFile(io.BytesIO(docx))
    assert archive.testzip() is None
    return xml.fromstring(archive.read("word/document.xml"))


def paragraphs(docx):
    """Returns the style and the text of each paragraph that has a text."""
    found = []
    for paragraph in body_of(docx).iter(W + "p"):
        text = "".join(each.text or "" for each in paragraph.iter(W + "t"))
        style = paragraph.find(f"{W}pPr/{W}pStyle")
        if text:
            found.append(("" if style is None else style.get(W + "val"), text))
    return found


def headings(docx, level=None):
    return [
        text
        for style, text in paragraphs(docx)
        if re.fullmatch("Heading" + (str(level) if level else r"\d"), style)
    ]


def rows(docx):
    """Returns the cells of all tables, as rows of texts."""
    return [
        [
            "".join(each.text or "" for each in cell.iter(W + "t")).strip()
            for cell in row.iter(W + "tc")
        ]
        for row in body_of(docx).iter(W + "tr")
    ]


def pictures_mm(docx):
    """Returns the width and the height of each picture."""
    return [
        (int(extent.get("cx")) / EMU_PER_MM, int(extent.get("cy")) / EMU_PER_MM)
        for extent in body_of(docx).iter(DRAWING + "extent")
    ]


def pdf_text(pdf):
    done = subprocess.run(["pdftotext", "-", "-"], input=pdf, capture_output=True, check=True)
    return done.stdout.decode()


@pytest.fixture(scope="module")
def server(server):
    server.import_model(vessel(), "column.ply", name="Column", unit="mm")
    server.ok(
        "PATCH",
        M,
        {
            "scale_verified": True,
            "inventory_number": "1927.14",
            "owner": "City museum",
            "credit": "Scan: Ada",
        },
    )
    damage = {"mode": "categorical", "points": [{"at": 1, "color": "#d04020", "label": "Scaling"}]}
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Damage",
            "labels": {"de": "Schäden"},
            "type": "u8",
            "resolution": 2048,
            "palette": damage,
        },
    )
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Finds",
            "columns": [
                {"name": "Name", "required": True},
                {"name": "Depth", "kind": "numeric", "unit": "mm", "labels": {"de": "Tiefe"}},
                {"name": "Safe", "kind": "boolean"},
                {"name": "Photos", "kind": "picture"},
                {"name": "Price", "kind": "numeric", "visibility": "private"},
            ],
        },
    )
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Finds", "kind": "database", "type": "u16", "table": "finds", "resolution": 2048},
    )
    for name, depth in (("Crack at the rim", 2.5), ("Salt", 1.25), ("Lost & found <b>", 12)):
        values = {"name": name, "depth": depth, "safe": depth > 2, "price": 987}
        server.ok("POST", "/tables/finds/records", {"values": values}, expect=(201,))
    edits = {"damage": (1, "z > 40"), "finds": (1, "z > 70 and x > 0")}
    for layer, (value, where) in edits.items():
        fill(server, layer, value, where)
    fill(server, "finds", 2, "z < 20 and x < 0 and y > 0")
    server.request(
        "POST",
        "/tables/finds/records/1/attachments?name=rim.png",
        png(64, 32, lambda x, y: (200, 10, 10)),
        headers={"Content-Type": "image/png"},
    )
    return server


def fill(server, layer, value, where):
    server.ok(
        "POST",
        f"{M}/layers/{layer}/edits",
        {"op": "fill", "mode": "where", "where": where, "value": value},
    )


def test_a_report_has_all_sections_with_their_content(server):
    answer = report(server)
    assert answer.headers["Content-Type"] == DOCX, answer.headers
    assert "column-report.docx" in answer.headers["Content-Disposition"], answer.headers
    assert headings(answer.body, 1) == [
        "Object",
        "Measured drawings",
        "Legend and quantities",
        "Findings",
        "Methods",
        "Provenance of the data",
    ]
    assert headings(answer.body, 2) == ["Finds", "Damage", "Finds"], "quantities, then findings"
    assert headings(answer.body, 3) == ["Crack at the rim", "Salt"]
    cells = rows(answer.body)
    assert ["Inventory number", "1927.14"] in cells, cells
    assert ["Size (x × y × z)", "80 mm × 80 mm × 80 mm"] in cells, cells
    assert ["Depth", "2.5 mm"] in cells and ["Safe", "yes"] in cells, cells
    # Half of the wall: 2 π · 40 mm · 40 mm
    damage = server.ok("GET", M + "/layers/damage/quantities").json()["quantities"][0]
    assert abs(damage["area_m2"] - 2 * math.pi * 0.04 * 0.04) < 1e-4
    row = next(row for row in cells if row[0] == "Scaling")
    assert row[1:] == ["1", f"{damage['area_m2'] * 1e4:.1f} cm²", f"{100 * damage['share']:.3g} %"]
    texts = [text for _, text in paragraphs(answer.body)]
    assert "Column" in texts and "Condition report" in texts, texts[:5]
    # Four drawings, the places of two records, and one photograph.
    sizes = pictures_mm(answer.body)
    assert len(sizes) == 7, sizes
    assert [round(width, 2) for width, _ in sizes].count(170) == 4, sizes


def test_areas_of_the_findings_are_those_of_the_statistics(server):
    keys = server.ok("GET", M + "/layers/finds/quantities").json()["quantities"]
    cells = rows(report(server, sections=[{"part": "findings"}], **FAST).body)
    areas = [row[1] for row in cells if row[0] == "Area"]
    assert areas == [f"{each['area_m2'] * 1e4:.4g} cm²" for each in keys], (areas, keys)


def test_a_report_is_written_in_german_and_spanish(server):
    german = report(server, language="de", **FAST).body
    assert headings(german, 1)[1:3] == ["Legende und Mengen", "Befunde"]
    assert "Schäden" in headings(german, 2), headings(german)
    assert ["Tiefe", "2,5 mm"] in rows(german) and ["Safe", "ja"] in rows(german), rows(german)
    spanish = pdf_text(report(server, language="es", format="pdf", **FAST).body)
    for words in (
        "Informe de estado de conservación",
        "Leyenda y cantidades",
        "2,5 mm",
        "Hallazgos",
    ):
        assert words in spanish, spanish


def test_the_pdf_has_the_same_content_and_its_drawings_to_scale(server, tmp_path):
    wish = {"figures": [{"direction": "front", "scale": 2}], "author": "Nora", "format": "pdf"}
    answer = report(server, **wish)
    text = pdf_text(answer.body)
    for words in ("Condition report", "1927.14", "Nora", "Crack at the rim", "Lost", "Scaling"):
        assert (words in text) == (words != "Lost"), (words, text)  # Lost is not painted
    path = tmp_path / "report.pdf"
    path.write_bytes(answer.body)
    done = subprocess.run(["pdfimages", "-list", path], capture_output=True, check=True, text=True)
    drawing = done.stdout.splitlines()[2].split()
    # The columns 12 and 13 are the pixels per inch on paper.
    assert abs(int(drawing[12]) - 200) <= 1 and abs(int(drawing[13]) - 200) <= 1, done.stdout
    facts = subprocess.run(["pdfinfo", path], capture_output=True, check=True, text=True).stdout
    assert re.search(r"Title:\s+Column", facts) and re.search(r"Author:\s+Nora", facts), facts


def test_sections_can_be_chosen_ordered_and_written(server):
    sections = [
        {"part": "measures", "text": "Consolidate.\n\nThen clean\nthe rim."},
        {"part": "condition", "heading": "Survey of damages", "text": "Good & stable <mostly>."},
        {"part": "object"},
    ]
    body = report(server, sections=sections, **FAST).body
    assert headings(body) == ["Recommended measures", "Survey of damages", "Object"]
    texts = [text for _, text in paragraphs(body)]
    begin = texts.index("Recommended measures")
    assert texts[begin + 1] == "Consolidate." and texts[begin + 2].startswith("Then clean"), texts
    assert "Good & stable <mostly>." in texts
    # A section without content is omitted.
    assert headings(report(server, sections=[{"part": "condition"}]).body) == []


def test_layers_and_records_can_be_limited(server):
    body = report(server, layers=["damage"], **FAST).body
    assert headings(body, 2) == ["Damage"] and not headings(body, 3), headings(body)
    body = report(server, max_records=1, **FAST).body
    assert headings(body, 3) == ["Crack at the rim"]
    assert "1 of 2 records are shown." in [text for _, text in paragraphs(body)]
    assert not headings(report(server, max_records=0, **FAST).body, 3)


def test_the_title_block_has_a_logo_and_own_rows(server):
    logo = base64.b64encode(png(300, 100, lambda x, y: (0, 90, 160))).decode()
    fields = [{"label": "Commission", "value": "Town of Ávila"}, {"label": "Empty", "value": ""}]
    wish = {"title": "Column 7", "subject": "Second survey", "fields": fields, "logo": logo}
    body = report(server, **wish, **{**FAST, "sections": [{"part": "object"}]}).body
    texts = [text for _, text in paragraphs(body)]
    for words in ("Column 7", "Second survey", "Commission", "Town of Ávila"):
        assert words in texts, texts
    assert len(pictures_mm(body)) == 1
    for bad, status in (("not base64!", 422), (base64.b64encode(b"text").decode(), 415)):
        assert report(server, expect=status, logo=bad, **FAST).json()["field"] == "logo"
    large = base64.b64encode(bytes(500_001)).decode()
    assert report(server, expect=413, logo=large, **FAST).json()["field"] == "logo"


def test_a_saved_view_is_a_figure_with_its_layers(server):
    camera = camera_from(server.ok("GET", M).json(), (0, -1, 0))
    view = {
        "name": "South side",
        "camera": camera,
        "layers": [{"layer": "damage", "visible": False}],
    }
    slug = server.ok("POST", M + "/views", view).json()["slug"]
    figures = [{"view": slug}, {"direction": "top", "caption": "From above"}]
    body = report(server, figures=figures, sections=[{"part": "figures"}]).body
    captions = [text for style, text in paragraphs(body) if style == "Caption"]
    assert captions == ["South side", "From above"], paragraphs(body)
    # The view shows records of a layer that the report leaves out.
    answer = report(server, figures=figures[:1], layers=["damage"])
    assert headings(answer.body, 2) == ["Damage"] and len(pictures_mm(answer.body)) == 1


def test_faulty_requests_name_the_field(server):
    twice = [{"part": "object"}, {"part": "object"}]
    for field, status, wish in (
        ("sections[1].part", 422, {"sections": twice}),
        ("sections[0].part", 422, {"sections": [{"part": "weather"}]}),
        ("layers", 404, {"layers": ["nothing"]}),
        ("figures[1].view", 422, {"figures": [{"direction": "top"}, {"view": "nothing"}]}),
        ("figures[0].scale", 422, {"figures": [{"direction": "top", "scale": 0}]}),
        ("language", 422, {"language": "fr"}),
        ("max_records", 422, {"max_records": 1001}),
    ):
        problem = report(server, expect=status, **wish).json()
        assert problem["field"].startswith(field), (wish, problem)


def test_a_report_contains_only_what_its_reader_sees(server):
    hidden = {"name": "Secret", "type": "u8", "resolution": 2048, "visibility": "private"}
    server.ok("POST", M + "/layers", hidden)
    fill(server, "secret", 3, "z > 10")
    for role, sees in (("curator", True), ("viewer", False)):
        token = server.add_person(f"report-{role}", role)
        body = report(server, token=token, **FAST).body
        assert ("Secret" in headings(body, 2)) == sees, (role, headings(body))
        assert (["Price", "987"] in rows(body)) == sees, (role, rows(body))


def test_lines_and_points_are_findings_and_quantities(server):
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Cracks",
            "columns": [
                {"name": "Name", "required": True},
                {"name": "Course", "kind": "line"},
                {"name": "Samples", "kind": "point"},
            ],
        },
    )
    wish = {"name": "Cracks", "kind": "database", "type": "u16", "table": "cracks"}
    server.ok("POST", M + "/layers", {**wish, "resolution": 2048})
    model = server.ok("GET", M).json()["id"]
    course = {"model": model, "coordinates": [[40, 0, 10], [40, 0, 25], [40, 0, 40]]}
    sample = {"model": model, "coordinates": [[40, 0, 10]]}
    values = {"name": "Long crack", "course": [course], "samples": [sample, sample]}
    server.ok("POST", "/tables/cracks/records", {"values": values}, expect=(201,))
    wish = {"layers": ["cracks"], "language": "de", "figures": []}
    body = report(server, **wish).body
    assert headings(body, 3) == ["Long crack"]
    cells = rows(body)
    assert ["Länge", "30 mm"] in cells and ["Punkte", "2"] in cells, cells
    assert ["Long crack", "0", "0 mm²", "30 mm", "2", "0 %"] in cells, cells
    assert len(pictures_mm(body)) == 1, "the place of the crack"


def test_ranges_have_the_words_and_the_decimals_of_the_language(server):
    palette = {
        "mode": "step",
        "points": [{"at": 0.5, "color": "#0000ff"}, {"at": 1.25, "color": "#ff0000"}],
    }
    wish = {"name": "Moisture", "type": "f32", "unit": "%", "resolution": 2048, "palette": palette}
    server.ok("POST", M + "/layers", wish)
    for value, where in ((0.75, "z > 40"), (2, "z > 60")):
        fill(server, "moisture", value, where)
    for language, named in (("de", "von 0,5 bis 1,25 %"), ("es", "de 0,5 a 1,25 %")):
        wish = {"layers": ["moisture"], "language": language, "sections": [{"part": "quantities"}]}
        cells = rows(report(server, **wish).body)
        assert any(row[0] == named for row in cells), cells


def test_a_picture_that_cannot_be_shown_is_named(server):
    server.ok(
        "POST",
        "/tables/finds/records/2/attachments?name=broken.png",
        png(64, 32, lambda x, y: (200, 10, 10))[:60],
        headers={"Content-Type": "image/png"},
    )
    wish = {"sections": [{"part": "findings"}], "layers": ["finds"], **FAST}
    cells = [cell for row in rows(report(server, **wish).body) for cell in row]
    assert "broken.png (this picture cannot be shown)" in cells, cells


def test_a_job_makes_the_report_and_can_be_cancelled(server):
    prefer = {"Prefer": "respond-async"}
    answer = server.request("POST", M + "/report", {"format": "pdf"}, headers=prefer)
    assert answer.status == 202, answer
    job = answer.json()["id"]
    done = server.wait_for_job(job)
    assert done["state"] == "done" and done["file"]["name"] == "column-report.pdf", done
    file = server.ok("GET", f"/jobs/{job}/file")
    assert file.body.startswith(b"%PDF-") and len(file.body) == done["file"]["bytes"]
    many = {"figures": [{"direction": "front"}] * 24}
    job = server.request("POST", M + "/report", many, headers=prefer).json()["id"]
    server.ok("DELETE", f"/jobs/{job}")
    assert server.wait_for_job(job)["state"] == "cancelled"
