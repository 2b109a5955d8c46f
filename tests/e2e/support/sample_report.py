"""The sample of a condition report in docs/public: its site and its files.

`scripts/sample_report` writes the files, and sample_report_test.py compares them with what the server
writes."""
import re
import subprocess
import sys
import xml.etree.ElementTree as xml
import zipfile
from io import BytesIO
from pathlib import Path

from support.cameras import camera_from
from support.pictures import png
from support.strata_server import StrataServer

DOCS = Path(__file__).resolve().parents[3] / "docs"
NAME = "condition-report"
PICTURE = "report.png"
M = "/models/demo-pot"
PAGES = (2, 3)  # the pages in the guide's picture
WIDTH = 620  # of a page in the picture, in pixels
GAP = 20
REQUEST = {
    "author": "Nora Weiß",
    "fields": [
        {"label": "Client", "value": "Museum of the demo site"},
        {"label": "Occasion", "value": "Loan to the exhibition “Vessels”"},
        {"label": "Place of examination", "value": "Conservation studio, raking light"},
    ],
    "sections": [
        {"part": "object"},
        {
            "part": "condition",
            "text": "The pot was reassembled from 14 sherds. All joints are stable.\n\n"
            "Several cracks cross the wall. The open cracks are described as findings. "
            "The rim has small losses. The surface has no salts.",
        },
        {"part": "figures"},
        {"part": "quantities"},
        {"part": "findings"},
        {
            "part": "measures",
            "text": "Fill the open cracks before the loan.\n\n"
            "Pack the pot in a box with a fitted foam, and do not lift it by the rim.",
        },
        {"part": "methods"},
        {"part": "provenance"},
    ],
    "layers": ["cracks", "damage"],
    "figures": [{"direction": "front"}, {"direction": "back"}],
}
FINDINGS = (
    ("Crack below the rim", "Open, edges clean", 0.4, "cracks = 3 and z > 62"),
    ("Crack in the wall", "Open, dust inside", 0.6, "cracks = 3 and z > 30 and z <= 62"),
    ("Crack at the foot", "Open, filled with plaster earlier", 0.5, "cracks = 3 and z <= 30"),
)


def make_site(server):
    """Adds the records of the report to the demo site."""
    server.ok(
        "POST",
        "/projects/demo/tables",
        {
            "name": "Damage",
            "columns": [
                {"name": "Name", "required": True},
                {"name": "State"},
                {"name": "Width", "kind": "numeric", "unit": "mm"},
                {"name": "Photos", "kind": "picture"},
            ],
        },
    )
    layer = {"name": "damage", "kind": "database", "type": "u16", "table": "damage"}
    server.ok("POST", M + "/layers", {**layer, "resolution": 2048})
    for key, (name, state, width, where) in enumerate(FINDINGS, start=1):
        values = {"name": name, "state": state, "width": width}
        server.ok("POST", "/tables/damage/records", {"values": values})
        fill = {"op": "fill", "mode": "where", "where": where, "value": key}
        server.ok("POST", M + "/layers/damage/edits", fill)
    camera = camera_from(server.ok("GET", M).json(), (0.3, -1, 0.3), width=800, height=600)
    shown = {"camera": camera, "layers": ["cracks"], "format": "png"}
    server.ok(
        "POST",
        "/tables/damage/records/1/attachments?name=rim.png",
        server.ok("POST", M + "/frame", shown).body,
        headers={"Content-Type": "image/png"},
    )


def report(server, media):
    """Returns the sample as bytes. `media` is "docx" or "pdf"."""
    return server.ok("POST", M + "/report", {**REQUEST, "format": media}).body


def without_numbers(text):
    """Some numbers differ in each report, such as the date and the time of the state."""
    return re.sub(r"\d+", "0", text)


def docx_texts(docx):
    """Returns the text of each paragraph, without numbers."""
    body = xml.fromstring(zipfile.ZipFile(BytesIO(docx)).read("word/document.xml"))
    space = "{http://schemas.openxmlformats.org/wordprocessingml/2006/main}"
    texts = [
        "".join(each.text or "" for each in paragraph.iter(space + "t"))
        for paragraph in body.iter(space + "p")
    ]
    return [without_numbers(text) for text in texts if text]


def pdf_words(pdf):
    done = subprocess.run(["pdftotext", "-", "-"], input=pdf, capture_output=True, check=True)
    return without_numbers(done.stdout.decode()).split()


def kept(media):
    """Returns the sample in the guide as bytes."""
    return DOCS.joinpath("public", f"{NAME}.{media}").read_bytes()


def pixels_of(pdf, page):
    """Returns the width, the height and the RGB bytes of a page."""
    options = ["-f", str(page), "-l", str(page), "-scale-to-x", str(WIDTH), "-scale-to-y", "-1"]
    done = subprocess.run(["pdftoppm", *options, "-"], input=pdf, capture_output=True, check=True)
    kind, size, most, pixels = done.stdout.split(b"\n", 3)
    assert (kind, most) == (b"P6", b"255"), (kind, size, most)
    width, height = map(int, size.split())
    return width, height, pixels


def picture_of(pdf):
    """Returns a PNG with two pages next to each other, on gray."""
    shown = [pixels_of(pdf, page) for page in PAGES]
    wide = sum(width for width, _, _ in shown) + GAP * (len(shown) + 1)
    high = max(height for _, height, _ in shown) + 2 * GAP
    canvas = bytearray(b"\xd8\xd6\xd2" * (wide * high))
    left = GAP
    for width, height, pixels in shown:
        for y in range(height):
            start = 3 * ((y + GAP) * wide + left)
            canvas[start : start + 3 * width] = pixels[3 * y * width : 3 * (y + 1) * width]
        left += width + GAP
    return png(wide, high, lambda x, y: canvas[3 * (y * wide + x) : 3 * (y * wide + x) + 3])


def write(docs):
    """Writes the samples and the picture of the guide."""
    with StrataServer(demo=True) as server:
        make_site(server)
        files = {media: report(server, media) for media in ("docx", "pdf")}
    for media, content in files.items():
        docs.joinpath("public", f"{NAME}.{media}").write_bytes(content)
    docs.joinpath("pictures", PICTURE).write_bytes(picture_of(files["pdf"]))


if __name__ == "__main__":
    write(Path(sys.argv[1]))
