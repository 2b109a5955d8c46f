"""Metadata of a project for a repository, its citation, deposits (RO-Crate in BagIt), and the import
of a deposit as a new project. Damaged deposits are refused."""
import io
import json
import os
import pathlib
import random
import shutil
import struct
import subprocess
import xml.etree.ElementTree as ElementTree
import zipfile

import numpy
import pytest
from support import bags
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png
from support.strata_server import StrataServer

P = "/projects/default"
SIDE = 2048  # texels of a layer
M = "/models/sheet"
POINT = [50, 40, 3]
PDF = b"%PDF-1.4\n" + bytes(range(256)) * 20
DATACITE = "{http://datacite.org/schema/kernel-4}"
RECORD = {
    "titles": [{"title": "Survey of the sheet"}, {"title": "Mesa", "kind": "translated"}],
    "creators": [
        {
            "name": "Muster, Ada",
            "orcid": "0000-0002-1825-0097",
            "affiliations": [{"name": "DataCite", "ror": "04wxnsj81"}],
        },
        {"kind": "organization", "name": "Museum & Söhne"},
    ],
    "contributors": [
        {"agent": {"name": "Roe, Jane"}, "contribution": "data_curator"},
    ],
    "publisher": {"name": "Zenodo"},
    "year": 2026,
    "language": "en",
    "version": "2",
    "subjects": [{"subject": "stone", "scheme": "AAT", "uri": "http://vocab.getty.edu/aat/1"}],
    "dates": [{"date": "2024-05/2024-07", "kind": "collected"}],
    "descriptions": [{"text": "A test of < and &."}],
    "rights": [{"license": "cc-by-4.0"}],
    "related": [
        {
            "identifier": "https://doi.org/10.1000/182",
            "kind": "doi",
            "relation": "is_supplement_to",
        }
    ],
    "funding": [{"funder": {"name": "A foundation"}, "award_number": "7"}],
    "places": [{"name": "Granada", "longitude": -3.6, "latitude": 37.2}],
    "doi": "https://doi.org/10.5281/zenodo.1234567",
}


def raster(kind, draw):
    """A file for texels.npy with a value at about every third texel."""
    rng = numpy.random.default_rng(1)
    texels = numpy.zeros((SIDE, SIDE), [("value", "<" + kind), ("valid", "?")])
    texels["valid"] = rng.random((SIDE, SIDE)) < 0.3
    texels["value"] = draw(rng).astype(kind)
    texels["value"][~texels["valid"]] = 0
    file = io.BytesIO()
    numpy.save(file, texels)
    return file.getvalue()


LAYERS = {
    "moisture": ("f32", raster("f4", lambda rng: rng.uniform(-1e6, 1e6, (SIDE, SIDE)))),
    "shift": ("i16", raster("i2", lambda rng: rng.integers(-32768, 32768, (SIDE, SIDE)))),
    "half": ("f16", raster("f2", lambda rng: rng.uniform(-9, 9, (SIDE, SIDE)))),
}


def strata(*words):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], *words], capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(20), "sheet.ply", name="Sheet", unit="mm")
    for name, (kind, content) in LAYERS.items():
        server.ok("POST", M + "/layers", {"name": name, "type": kind, "resolution": SIDE})
        server.ok("PUT", f"{M}/layers/{name}/texels.npy", content)
    make_tables(server)
    server.ok("PUT", f"{M}/layers/finds/texels.npy", keys())
    double = {"name": "double", "type": "f32", "expression": "moisture * 2"}
    job = server.ok("POST", M + "/layers", double).json()
    if "state" in job:
        assert server.wait_for_job(job["id"])["state"] == "done"
    make_parts(server)
    return server


def keys():
    return raster("u2", lambda rng: rng.integers(1, 4, (SIDE, SIDE)))


def make_tables(server):
    server.ok(
        "POST",
        P + "/tables",
        {
            "name": "kinds",
            "columns": [
                {"name": "code", "kind": "text", "required": True, "unique": True},
                {"name": "label", "kind": "text"},
            ],
        },
    )
    parent = {"name": "parent", "kind": "term", "target": "kinds"}
    server.ok("POST", "/tables/kinds/columns", parent)
    for code, parent in (("loss", None), ("flake", 1), ("hole", 1)):
        values = {"code": code, "label": code.title(), "parent": parent}
        server.ok("POST", "/tables/kinds/records", {"values": values})
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "finds",
            "type": "u16",
            "kind": "database",
            "resolution": SIDE,
            "columns": [
                {"name": "note", "kind": "text"},
                {"name": "width", "kind": "numeric", "minimum": 0, "unit": "mm"},
                {"name": "seen", "kind": "date"},
                {"name": "safe", "kind": "boolean", "default": True},
                {"name": "kind", "kind": "term", "target": "kinds", "required": True},
                {"name": "reports", "kind": "document"},
                {"name": "samples", "kind": "point"},
            ],
        },
    )
    above = {"name": "above", "kind": "relation", "target": "finds"}
    server.ok("POST", "/tables/finds/columns", above)
    model = server.get(M).json()["id"]
    rows = [
        {"note": '=größer; "x",\nnext', "width": 0.1 + 0.2, "kind": 2, "safe": None},
        {"note": "'; DROP TABLE x; --", "seen": "2024-02-29", "kind": 3, "above": [1]},
        {"note": None, "kind": 1, "samples": [{"model": model, "coordinates": [[1, 2, 0.25]]}]},
    ]
    for values in rows:
        server.ok("POST", "/tables/finds/records", {"values": values})
    for name in ("a b.pdf", "A B.pdf"):
        server.ok(
            "POST",
            f"/tables/finds/records/2/attachments?name={name.replace(' ', '%20')}&column=reports",
            PDF + name.encode(),
            headers={"Content-Type": "application/pdf"},
        )


def make_tour(server, model):
    view = {
        "name": "West",
        "camera": camera_from(model, (0, -0.2, 1)),
        "layers": [{"layer": "shift", "opacity": 0.5, "visible": True}],
        "light": {"mode": "museum"},
    }
    server.ok("POST", M + "/views", view)
    tour = {
        "name": "Round",
        "languages": ["en"],
        "idle_s": 60,
        "stops": [
            {
                "view": "west",
                "title": {"en": "Start"},
                "attract_s": 5,
                "transition_s": 1,
                "layers": ["finds"],
                "records": [{"table": "finds", "keys": [2], "columns": [{"column": "note"}]}],
            }
        ],
    }
    made = server.ok("POST", M + "/tours", tour)
    picture = png(8, 8, lambda x, y: (x, y, 200))
    file = server.ok("POST", M + "/tours/round/files?name=a.png", picture).json()["id"]
    stops = made.json()["stops"]
    stops[0]["media"] = [{"file": file, "alt": {"en": "A well"}}]
    server.ok("PATCH", M + "/tours/round", {"stops": stops, "theme": {"logo": file}})


def make_parts(server):
    make_tour(server, server.get(M).json())
    poses = b"#name,x,y,alt,heading,pitch,roll,f\nnorth.png,50,50,300,0,0,0,35\n"
    server.ok("POST", M + "/photograph-poses?filename=poses.csv", poses)
    server.ok("POST", M + "/photographs?filename=north.png", png(24, 16, lambda x, y: (x, y, 9)))
    server.ok("POST", M + "/looks?name=Photo", png(32, 32, lambda x, y: (x, 9, y)))
    server.ok(
        "POST",
        M + "/comments",
        {"text": "Look here", "position": POINT, "layer": "shift"},
    )

    for name, audience in (("Secret places", "personal"), ("Damp walls", "everyone")):
        body = {"name": name, "audience": audience, "within": {"where": "z > 0"}}
        server.ok("POST", M + "/selections", body)


@pytest.fixture(scope="module")
def record(server):
    """The saved metadata."""
    before = server.ok("GET", P + "/metadata")
    assert before.json()["version"] == 0 and "publisher" in before.json()["missing"]
    assert before.json()["record"]["titles"][0]["title"] == "Default"
    saved = server.ok("PUT", P + "/metadata", RECORD, headers={"If-Match": before.headers["ETag"]})
    assert saved.json()["missing"] == [] and saved.json()["version"] == 1
    return saved.json()["record"]


@pytest.fixture(scope="module")
def deposit(server, record):
    """The zip of the deposit."""
    job = server.wait_for_job(server.ok("POST", P + "/deposits").json()["id"])
    assert job["state"] == "done", job
    assert job["file"]["name"] == "default.zip", job
    return server.ok("GET", f"/jobs/{job['id']}/file").body


@pytest.fixture(scope="module")
def bag(deposit, tmp_path_factory):
    return bags.unpack(deposit, tmp_path_factory.mktemp("bag"))


def test_a_deposit_needs_complete_metadata(server):
    refused = server.post(P + "/deposits")
    assert refused.status == 422 and refused.json()["field"] == "creators", refused


def test_identifiers_are_checked_and_get_their_usual_form(server, record):
    assert record["doi"] == "10.5281/zenodo.1234567"
    assert record["creators"][0]["orcid"] == "https://orcid.org/0000-0002-1825-0097"
    assert record["creators"][0]["affiliations"][0]["ror"] == "https://ror.org/04wxnsj81"
    assert record["rights"] == [
        {"license": "CC-BY-4.0", "uri": "https://creativecommons.org/licenses/by/4.0/"}
    ]
    for change, field in (
        ({"creators": [{"name": "A", "orcid": "0000-0002-1825-0098"}]}, "creators[0].orcid"),
        ({"publisher": {"name": "A", "ror": "04wxnsj82"}}, "publisher.ror"),
        ({"creators": [{"name": "A", "ror": "04wxnsj81"}]}, "creators[0].ror"),
        ({"rights": [{"license": "CC-BY-9"}]}, "rights[0].license"),
        ({"rights": [{"uri": "http://rightsstatements.org/vocab/X/1.0/"}]}, "rights[0].uri"),
        ({"dates": [{"date": "2024-13", "kind": "created"}]}, "dates[0].date"),
        ({"doi": "10.1/not a doi"}, "doi"),
        ({"places": [{"latitude": 2}]}, "places[0].longitude"),
    ):
        refused = server.request("PUT", P + "/metadata", change)
        assert refused.status == 422 and refused.json()["field"] == field, refused
    stale = server.request("PUT", P + "/metadata", RECORD, headers={"If-Match": '"v0"'})
    assert stale.status == 412, stale
    assert server.ok("GET", P + "/metadata").json()["record"] == record


def test_only_curators_change_metadata_and_make_deposits(server, record):
    viewer = server.add_person("vera", "viewer")
    assert server.get(P + "/metadata", token=viewer).json()["record"] == record
    assert server.request("PUT", P + "/metadata", RECORD, token=viewer).status == 403
    assert server.request("POST", P + "/deposits", token=viewer).status == 403
    rights = {"rights_uri": "CC0-1.0", "rights_holder": "M"}
    path = M + "/photographs/rights"
    assert server.request("PUT", path, rights, token=viewer).status == 403


def test_photographs_have_a_license_and_a_rights_holder(server):
    path = M + "/photographs/rights"
    wrong = server.request("PUT", path, {"rights_uri": "CC-9", "rights_holder": ""})
    assert wrong.status == 422 and wrong.json()["field"] == "rights_uri", wrong
    body = {"rights_uri": "CC-BY-SA-4.0", "rights_holder": "Ada Muster"}
    assert server.ok("PUT", path, {**body, "photographs": [999999]}).json() == {"changed": 0}
    assert server.ok("PUT", path, body).json() == {"changed": 1}
    shown = server.get(M + "/photographs").json()["photographs"][0]
    assert {name: shown[name] for name in body} == body


def test_the_citation_has_the_usual_formats(server, record):
    def cite(form):
        return server.ok("GET", f"{P}/citation?f={form}").body.decode()

    assert cite("text") == (
        "Muster, Ada & Museum & Söhne (2026). Survey of the sheet (Version 2) [Dataset]. Zenodo. "
        "https://doi.org/10.5281/zenodo.1234567"
    )
    assert "author = {Muster, Ada and {Museum \\& Söhne}}," in cite("bibtex")
    ris = cite("ris").split("\r\n")
    assert ris[0] == "TY  - DATA" and "AU  - Muster, Ada" in ris and ris[-2] == "ER  - "
    item = json.loads(cite("csl"))[0]
    assert item["author"][0] == {"family": "Muster", "given": "Ada"}
    assert item["issued"] == {"date-parts": [[2026]]} and item["DOI"] == record["doi"]
    attributes = json.loads(cite("datacite"))
    assert attributes["relatedIdentifiers"][0] == {
        "relatedIdentifier": "10.1000/182",
        "relatedIdentifierType": "DOI",
        "relationType": "IsSupplementTo",
    }
    assert attributes["rightsList"][0]["rightsIdentifier"] == "CC-BY-4.0"
    assert json.loads(cite("jsonld"))["@type"] == "Dataset"
    resource = ElementTree.fromstring(cite("datacite-xml"))
    assert [child.tag.removeprefix(DATACITE) for child in resource] == [
        *("identifier", "creators", "titles", "publisher", "publicationYear", "resourceType"),
        *("subjects", "contributors", "dates", "language", "relatedIdentifiers", "version"),
        *("rightsList", "descriptions", "geoLocations", "fundingReferences"),
    ]
    assert resource.findtext(f".//{DATACITE}description") == "A test of < and &."


def test_the_deposit_is_a_valid_bag_and_ro_crate(server, bag):
    info = bags.check_bag(bag)
    assert info["Source-Organization"] == "Zenodo"
    root = os.path.join(bag, "data")
    entities = bags.check_crate(root)
    author = entities["https://orcid.org/0000-0002-1825-0097"]
    assert author["name"] == "Muster, Ada"
    files = bags.files_under(root)
    assert files["models/sheet/scan/sheet.ply"] == folded_grid(20)
    texels = server.ok("GET", M + "/layers/moisture/texels.tif").body
    assert files["models/sheet/layers/moisture.tif"] == texels
    assert files["models/sheet/mesh/surface.glb"].startswith(b"glTF")
    history = files["models/sheet/layers/moisture-history.csv"].decode()
    assert history.count("\r\n") == 2 and ",import," in history
    assert b"skos:Concept" in files["tables/kinds.ttl"]
    rows = bags.check_csvw(root, "tables/finds.csv-metadata.json")
    assert [row["key"] for row in rows] == ["1", "2", "3"]
    photograph = entities["models/sheet/photographs/north.png"]
    assert photograph["license"]["@id"] == "https://creativecommons.org/licenses/by-sa/4.0/"
    assert b"password" not in b"".join(files.values()).lower()


def test_the_download_of_a_deposit_is_in_the_audit_log(server, deposit):
    rows = server.get("/audit?action=export").json()["entries"]
    assert any(row["subject"] == "default.zip" for row in rows), rows


def state_of(server, project):
    """Everything that a deposit keeps, without ids, times and authors."""
    model = next(m for m in server.get("/models").json()["models"] if m["project"] == project)[
        "slug"
    ]
    state = {}
    at = f"/models/{model}"
    names = {}
    for layer in server.get(at + "/layers").json()["layers"]:
        slug = layer["slug"]
        names[layer["id"]] = slug
        state["texels", slug] = server.ok("GET", f"{at}/layers/{slug}/texels.npy").body
        kept = ("name", "type", "resolution", "palette", "expression", "opacity", "kind", "order")
        state["layer", slug] = {key: layer.get(key) for key in kept}
    described = server.get(at).json()
    kept = ("unit", "up", "triangles", "vertices", "bounds", "origin", "area_m2", "atlas")
    state["model"] = {key: described[key] for key in kept}
    state["scan"] = [(file["name"], file["sha256"]) for file in described["source_files"]]
    tables = server.get(f"/projects/{project}/tables").json()["tables"]
    for table in tables:
        columns = table["columns"]
        for column in columns:
            column.pop("id")
            if "target" in column:
                target = next(t for t in tables if t["id"] == column["target"])
                column["target"] = target["name"]
        page = server.get(f"/tables/{table['id']}/records?limit=1000").json()
        records = [{"key": r["key"], **r["values"]} for r in page["records"]]
        for values in records:
            for sample in values.get("samples") or []:
                sample["model"] = "sheet"
            if values.get("reports"):
                values["reports"] = [
                    server.ok("GET", f"/attachments/{i if isinstance(i, int) else i['id']}").body
                    for i in values["reports"]
                ]
        state["table", table["name"]] = (columns, records)
    photographs = server.get(at + "/photographs").json()["photographs"]
    for photograph in photographs:
        content = server.ok("GET", f"{at}/photographs/{photograph['id']}/picture").body
        photograph["id"] = content
    state["photographs"] = photographs
    images = server.get(at + "/looks").json()["looks"]
    state["images"] = [(i["name"], i["slug"], i["sha256"], i["visible"]) for i in images]
    view = server.get(at + "/views/west").json()
    shown = [(names[each["layer"]], each["opacity"]) for each in view["layers"]]
    state["view"] = (view["name"], view["camera"], view["light"], shown)
    tour = server.get(at + "/tours/round").json()
    for stop in tour["stops"]:
        for records in stop["records"]:
            records["table"] = "finds"
        for medium in stop["media"]:
            medium["file"] = server.ok("GET", f"{at}/tours/round/files/{medium['file']}").body
    logo = server.ok("GET", f"{at}/tours/round/files/{tour['theme']['logo']}").body
    state["tour"] = (tour["name"], tour["languages"], tour["stops"], logo)
    comments = server.get(at + "/comments").json()["comments"]
    state["comments"] = [(c["text"], c["position"], names.get(c["layer"])) for c in comments]
    return state


def check_same(there, here):
    assert set(there) == set(here)
    for part in here:
        assert there[part] == here[part], part


def test_the_import_on_another_site_has_the_same_texels_and_records(server, deposit, tmp_path):
    place = tmp_path / "default.zip"
    place.write_bytes(deposit)
    with StrataServer() as other:
        done = strata("import-deposit", str(place), "--slug", "again", "--data", other.data)
        assert done.returncode == 0, done
        assert "1 model, 5 layers, 2 tables, 6 records" in done.stdout, done
        check_same(state_of(other, "again"), state_of(server, "default"))
        assert other.get("/projects/again/metadata").json()["record"] == (
            server.get(P + "/metadata").json()["record"]
        )
        layer = other.get("/models/sheet/layers/double").json()
        assert not layer["stale"], layer
        # The new project can be changed and deposited like any other.
        other.ok("POST", "/tables/finds/records", {"values": {"note": "new", "kind": 1}})
        job = other.wait_for_job(other.ok("POST", "/projects/again/deposits").json()["id"])
        assert job["state"] == "done", job
        other.assert_clean_log()


def test_the_import_into_the_same_site_is_a_second_project(server, deposit, tmp_path):
    place = tmp_path / "default.zip"
    place.write_bytes(deposit)
    done = strata("import-deposit", str(place), "--data", server.data)
    assert done.returncode == 0 and "the project default-2" in done.stdout, done
    check_same(state_of(server, "default-2"), state_of(server, "default"))


def damaged(bag, folder, change):
    copy = os.path.join(folder, "bag")
    shutil.copytree(bag, copy)
    change(copy)
    return copy


def rewrite(copy, path, content):
    with open(os.path.join(copy, path), "wb") as file:
        file.write(content)


def test_damaged_deposits_are_refused_with_the_name_of_the_file(server, bag, tmp_path):
    texels = "data/models/sheet/layers/moisture.tif"

    def manifest_with(line):
        return lambda copy: rewrite(
            copy,
            "manifest-sha256.txt",
            open(os.path.join(bag, "manifest-sha256.txt"), "rb").read() + line,
        )

    cases = {
        "changed": (lambda copy: rewrite(copy, texels, b"II*\x00"), "bag-info.txt"),
        "missing": (lambda copy: os.remove(os.path.join(copy, texels)), texels),
        "extra": (lambda copy: rewrite(copy, "data/more.txt", b""), "data/more.txt"),
        "manifest": (manifest_with(b"0" * 64 + b"  data/x\n"), "manifest-sha256.txt"),
        "no manifest": (
            lambda copy: os.remove(os.path.join(copy, "manifest-sha256.txt")),
            "manifest-sha256.txt",
        ),
        "link": (
            lambda copy: (
                os.remove(os.path.join(copy, texels)),
                os.symlink("/etc/passwd", os.path.join(copy, texels)),
            ),
            texels,
        ),
    }
    for name, (change, told) in cases.items():
        copy = damaged(bag, tmp_path / name, change)
        done = strata("import-deposit", copy, "--data", server.data)
        assert done.returncode == 1 and told in done.stderr, (name, done)
    # One bit of a file
    with open(os.path.join(bag, texels), "rb") as file:
        content = bytearray(file.read())
    content[-1] ^= 1
    copy = damaged(bag, tmp_path / "bit", lambda copy: rewrite(copy, texels, content))
    done = strata("import-deposit", copy, "--check")
    assert done.returncode == 1 and texels in done.stderr and "checksum" in done.stderr, done
    assert strata("import-deposit", bag, "--check").returncode == 0


def zip_of(entries):
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in entries:
            file.writestr(name, content)
    return packed.getvalue()


def overlapping_zip():
    """A zip with several names for the same bytes, as in a zip bomb."""
    content = zip_of([("a/0", random.Random(2).randbytes(200_000))])
    end = content.rindex(b"PK\x05\x06")
    (start,) = struct.unpack("<I", content[end + 16 : end + 20])
    entry = content[start:end]
    entries = b"".join(entry.replace(b"a/0", f"a/{i}".encode()) for i in range(9))
    tail = bytearray(content[end:])
    tail[8:12] = struct.pack("<HH", 9, 9)
    tail[12:16] = struct.pack("<I", len(entries))
    return content[:start] + entries + bytes(tail)


def test_dangerous_zips_are_refused(server, tmp_path):
    outside = tmp_path / "outside.txt"
    for name, content, told in (
        ("up", zip_of([("bag/bagit.txt", "x"), ("bag/../../outside.txt", "x")]), "outside.txt"),
        ("absolute", zip_of([(str(outside), "x")]), "outside.txt"),
        ("backslash", zip_of([("bag\\..\\outside.txt", "x")]), "outside.txt"),
        ("twice", zip_of([("bag/a", "x"), ("bag/a/", "")]), "bag/a"),
        ("bomb", overlapping_zip(), "zip bomb"),
        ("empty", zip_of([]), "zip"),
        ("text", b"no zip at all", "zip"),
        ("no bag", zip_of([("bag/x", "x")]), "bagit.txt"),
    ):
        place = tmp_path / f"{name}.zip"
        place.write_bytes(content)
        done = strata("import-deposit", str(place), "--data", server.data)
        assert done.returncode == 1 and told in done.stderr, (name, done)
        assert not outside.exists(), name


def test_a_deposit_with_wrong_content_leaves_no_project(server, bag, tmp_path):
    """A bag with valid checksums whose records do not fit."""
    copy = tmp_path / "wrong"
    shutil.copytree(bag, copy)
    table = copy / "data/tables/finds.csv"
    table.write_bytes(table.read_bytes().replace(b"2024-02-29", b"2024-02-30"))
    sign(copy)
    before = server.get("/projects").json()["total"]
    done = strata("import-deposit", str(copy), "--slug", "wrong", "--data", server.data)
    assert done.returncode == 1 and "tables/finds.csv" in done.stderr, done
    assert server.get("/projects").json()["total"] == before
    project = copy / "data/project.json"
    project.write_text(project.read_text().replace('"columns"', '"colums"'))
    sign(copy)
    done = strata("import-deposit", str(copy), "--slug", "wrong", "--data", server.data)
    assert done.returncode == 1 and "project.json" in done.stderr, done
    assert server.get("/projects").json()["total"] == before


def sign(bag):
    """Writes new checksums."""
    import hashlib

    files = bags.files_under(bag)

    def lines(paths):
        return "".join(f"{hashlib.sha256(files[p]).hexdigest()}  {p}\n" for p in paths)

    payload = sorted(path for path in files if path.startswith("data/"))
    files["manifest-sha256.txt"] = lines(payload).encode()
    files["bag-info.txt"] = b""
    tags = ("bagit.txt", "bag-info.txt", "manifest-sha256.txt")
    for name in tags:
        rewrite(bag, name, files[name])
    rewrite(bag, "tagmanifest-sha256.txt", lines(tags).encode())


def test_a_deposit_has_no_personal_selections(bag):
    names = [
        each["name"]
        for file in pathlib.Path(bag).glob("data/models/*/model.json")
        for each in json.loads(file.read_text())["selections"]
    ]
    assert names == ["Damp walls"]
