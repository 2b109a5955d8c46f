"""Every kind of file that leaves Strata, made from the demo site. Each one is opened with a program or
library of others.

`scripts/sample_exports` writes the files, and sample_exports_test.py makes and opens them in a
temporary folder."""
import csv
import hashlib
import io
import json
import subprocess
import sys
import xml.etree.ElementTree as xml
import zipfile
from pathlib import Path

import ezdxf
import openpyxl

from . import glb
from .addresses import query
from .linked_contexts import json_ld_graph, turtle_graph
from .ply import read_ply
from .sample_report import M, make_site, report
from .strata_server import StrataServer

GIS = "//ogc/collections/demo-pot"
P = "/projects/demo"
HIDDEN = [{"layer": layer, "visible": False} for layer in ("pieces", "cracks")]
FRONT = {"direction": "front", "layers": HIDDEN}
METADATA = {
    "titles": [{"title": "Survey of a pot"}],
    "creators": [{"name": "Weiß, Nora", "orcid": "0000-0002-1825-0097"}],
    "publisher": {"name": "Museum of the demo site"},
    "year": 2026,
    "rights": [{"license": "CC-BY-4.0"}],
}


def run(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, (command, done.stdout, done.stderr)
    return done.stdout


# Each of these functions opens a file and returns the program and what it said.


def by_poppler(path):
    facts = dict(line.split(":", 1) for line in run("pdfinfo", str(path)).splitlines())
    size = facts["Page size"].strip()
    return "pdfinfo (poppler)", f"{facts['Pages'].strip()} pages, {size}"


def by_xml(path):
    root = xml.parse(path).getroot()
    return (
        "Python's XML parser",
        f"{root.tag.split('}')[-1]} with {len(list(root.iter()))} elements",
    )


def by_word(path):
    body = xml.fromstring(zipfile.ZipFile(path).read("word/document.xml"))
    kinds = [each.tag.split("}")[-1] for each in body.iter()]
    return "Python's ZIP and XML", f"{kinds.count('p')} paragraphs, {kinds.count('tbl')} tables"


def by_ezdxf(path):
    drawing = ezdxf.readfile(path)
    assert not drawing.audit().has_errors
    kinds = sorted({entity.dxftype() for entity in drawing.modelspace()})
    return "ezdxf", f"no error, {len(drawing.modelspace())} entities: {', '.join(kinds)}"


def by_gdal_raster(path):
    facts = json.loads(run("gdalinfo", "-json", str(path)))
    bands = ", ".join(band["type"] for band in facts["bands"])
    return "gdalinfo (GDAL)", f"{facts['driverShortName']}, {facts['size']}, {bands}"


def by_gdal_vector(path):
    said = run("ogrinfo", "-so", "-al", str(path))
    names = [line.split(": ")[1] for line in said.splitlines() if line.startswith("Layer name")]
    counts = [line.split(": ")[1] for line in said.splitlines() if line.startswith("Feature Count")]
    assert names and len(names) == len(counts), said
    layers = ", ".join(f"{name}: {count}" for name, count in zip(names, counts))
    return "ogrinfo (GDAL)", f"{layers} features"


def by_csv(path):
    rows = list(csv.reader(io.StringIO(path.read_text(encoding="utf-8-sig"))))
    assert len({len(row) for row in rows}) == 1, path
    return "Python's csv", f"{len(rows) - 1} rows, {len(rows[0])} columns"


def by_openpyxl(path):
    book = openpyxl.load_workbook(path)
    sheets = ", ".join(f"{sheet.title}: {sheet.max_row} rows" for sheet in book)
    return "openpyxl", sheets


def by_khronos(path):
    said = glb.validate(path)
    assert said["issues"]["numErrors"] == 0, said["issues"]
    info = said["info"]
    return "glTF validator (Khronos)", f"no error, {info['totalTriangleCount']} triangles"


def by_unzip(path):
    with zipfile.ZipFile(path) as files:
        assert files.testzip() is None
        return "Python's ZIP", ", ".join(sorted(files.namelist()))


def by_ply(path):
    vertices = read_ply(path.read_bytes())[0]
    return "a reader in the tests", f"{len(vertices)} vertices"


def by_rdflib(path):
    text = path.read_text()
    graph = turtle_graph(text) if path.suffix == ".ttl" else json_ld_graph(json.loads(text))
    return "rdflib", f"{len(graph)} statements"


def by_json(path):
    document = json.loads(path.read_text())
    return "Python's JSON parser", f"{document['type']} with {len(document)} members"


def by_bagit(path):
    """Checks the checksums of a bag (RFC 8493)."""
    with zipfile.ZipFile(path) as files:
        manifest = next(name for name in files.namelist() if "/manifest-sha256" in name)
        root = manifest.split("/")[0]
        lines = files.read(manifest).decode().splitlines()
        for line in lines:
            digest, name = line.split(maxsplit=1)
            assert hashlib.sha256(files.read(f"{root}/{name}")).hexdigest() == digest, name
        crate = json.loads(files.read(f"{root}/data/ro-crate-metadata.json"))
    said = f"{len(lines)} checksums match, {len(crate['@graph'])} entities in the RO-Crate"
    return "hashlib (BagIt)", said


def post(path, **body):
    return lambda server: server.ok("POST", path, body).body


def get(path, **parameters):
    return lambda server: server.ok("GET", query(path, **parameters) if parameters else path).body


def figure(**body):
    return post(M + "/figures", **{**FRONT, **body})


def deposit(server):
    server.ok("PUT", P + "/metadata", METADATA)
    job = server.ok("POST", P + "/deposits").json()["id"]
    server.wait_for_job(job)
    return server.ok("GET", f"/jobs/{job}/file").body


def bill(form):
    def file(server):
        bills = server.get(P + "/bills").json()["bills"]
        if not bills:
            table = server.get("/tables/damage").json()["id"]
            rules = [{"table": table, "measure": "area", "figure": "Front"}]
            items = [
                {"number": "01", "kind": "group", "short_text": "Cracks"},
                {
                    "number": "01.0010",
                    "short_text": "Fill open cracks",
                    "unit": "m2",
                    "unit_price": "900.00",
                    "rules": rules,
                    "rounding": {"places": 3},
                    "measurements": [{"text": "Foot", "formula": "2 * 0,02 * 0,03"}],
                },
            ]
            server.ok("POST", P + "/bills", {"name": "Conservation", "items": items})
            bills = server.get(P + "/bills").json()["bills"]
        return server.ok("GET", f"{P}/bills/{bills[0]['id']}/file?f={form}").body

    return file


def turtle_of_terms(server):
    terms = "code,label,label-de\nopen,Open,Offen\nfilled,Filled,Gefüllt\n"
    head = {"Content-Type": "text/csv"}
    server.ok("POST", P + "/terms?name=States", terms.encode(), headers=head)
    return server.ok("GET", "/tables/states/terms?f=turtle").body


# (file, how it is made, how it is opened)
EXPORTS = (
    ("report.docx", lambda server: report(server, "docx"), by_word),
    ("report.pdf", lambda server: report(server, "pdf"), by_poppler),
    ("figure.pdf", figure(format="pdf", areas="outlines"), by_poppler),
    ("figure.svg", figure(format="svg", areas="outlines"), by_xml),
    ("figure.dxf", figure(format="dxf"), by_ezdxf),
    ("figure.png", figure(format="png", dpi=100), by_gdal_raster),
    ("figure.tif", figure(format="tiff", dpi=100), by_gdal_raster),
    ("damage.glb", post(M + "/exports", features="damage", texture_size=1024), by_khronos),
    ("small.glb", get(M + "/surface.glb", layers="cracks", max_triangles=20_000), by_khronos),
    ("model-obj.zip", post(M + "/exports", format="obj", texture_size=1024), by_unzip),
    ("vertices.ply", get(M + "/vertices.ply", layers="cracks"), by_ply),
    ("damage.geojson", get(M + "/layers/damage/features", f="geojson"), by_gdal_vector),
    ("damage.gpkg", get(M + "/layers/damage/features", f="gpkg"), by_gdal_vector),
    ("cracks-plane.tif", get(GIS + ".cracks/coverage", f="tiff", width=400), by_gdal_raster),
    ("cracks-atlas.tif", get(M + "/layers/cracks/texels.tif"), by_gdal_raster),
    ("quantities.csv", get(M + "/layers/cracks/quantities", f="csv"), by_csv),
    ("quantities.xlsx", get(M + "/layers/cracks/quantities", f="xlsx"), by_openpyxl),
    ("records.csv", get("/tables/damage/records", f="csv"), by_csv),
    ("records.xlsx", get("/tables/damage/records", f="xlsx"), by_openpyxl),
    ("terms.ttl", turtle_of_terms, by_rdflib),
    ("model.ttl", get("//id/models/demo-pot", f="turtle"), by_rdflib),
    ("record.jsonld", get("//id/tables/damage/records/1", f="jsonld"), by_rdflib),
    ("annotations.jsonld", get("//id/models/demo-pot/layers/damage/annotations"), by_rdflib),
    ("manifest.json", get("//id/models/demo-pot/manifest"), by_json),
    ("bill.xlsx", bill("xlsx"), by_openpyxl),
    ("bill.x31", bill("x31"), by_xml),
    ("bill.x83", bill("x83"), by_xml),
    ("deposit.zip", deposit, by_bagit),
)


def write(server, folder):
    """Writes all files, opens them, and writes what the programs said. Returns the names."""
    lines = ["| file | size | opened by | what it said |", "|---|---|---|---|"]
    for name, make, opened in EXPORTS:
        path = folder / name
        path.write_bytes(make(server))
        program, said = opened(path)
        lines.append(f"| {name} | {path.stat().st_size / 1024:.0f} KiB | {program} | {said} |")
    (folder / "opened.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return [name for name, _, _ in EXPORTS]


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    with StrataServer(demo=True) as started:
        make_site(started)
        write(started, target)
    print((target / "opened.md").read_text(encoding="utf-8"))
