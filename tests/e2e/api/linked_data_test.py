"""Linked data: the documents under /id as JSON-LD and Turtle, read by an RDF library, and the IIIF
manifest with its surface."""
import json
import math
import os
import re
import tempfile

import numpy
import pytest
from support import glb
from support.addresses import query
from support.cameras import camera_from
from support.linked_contexts import OA, comparable, json_ld_graph, turtle_graph
from support.meshes import folded_grid
from support.project_sites import Someone
from support.readings import dab

SKOS = "http://www.w3.org/2004/02/skos/core#"
AAT_SALT = "http://vocab.getty.edu/aat/300011762"
TERMS = (
    f"code,label,label-de,definition,uri\nsalt,Salt,Salz,White crystals,{AAT_SALT}\nloss,Loss,,,\n"
)
HOSTILE = "</h1><script>alert(1)</script>"
MANY = 230  # classes of a layer, more than a page of annotations


def place(model, *corners):
    return [{"model": model, "coordinates": [list(corner) for corner in corners]}]


def make(server):
    server.import_model(folded_grid(fold=0.0001), "sheet.ply", name="Sheet", unit="mm")
    server.ok("PATCH", "/models/sheet", {"up": "y"})
    server.ok(
        "PATCH",
        "/models/sheet",
        {
            "inventory_number": "A 12",
            "owner": "City museum",
            "creator": "Scan team",
            "credit": "Photo: Ada",
            "rights_uri": "https://creativecommons.org/licenses/by/4.0/",
        },
    )
    server.ok("POST", "/projects/default/objects", {"name": "Panel"})
    panel = server.get("/projects/default/objects").json()["objects"][0]["id"]
    server.ok("PATCH", "/models/sheet", {"object": panel, "survey_date": "2024-02"})
    server.ok(
        "POST",
        "/projects/default/terms?name=Kinds",
        TERMS,
        headers={"Content-Type": "text/csv"},
    )
    kinds = server.get("/tables/kinds").json()["id"]
    sheet = server.get("/models/sheet").json()["id"]
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Damage",
            "columns": [
                {"name": "Code", "required": True},
                {"name": "Kind", "kind": "term", "target": kinds},
                {"name": "Depth", "kind": "numeric", "unit": "mm"},
                {"name": "Note"},
                {"name": "Crack", "kind": "line"},
                {"name": "Sample", "kind": "point"},
                {"name": "Secret", "visibility": "private"},
            ],
        },
    )
    for values in (
        {"code": "Efflorescence", "kind": 1, "depth": 2.5, "note": HOSTILE, "secret": "grave"},
        {"code": "Crack a", "crack": place(sheet, (20, 50, 0), (50, 50, 0), (50, 90, 0))},
        {"code": "Sample", "sample": place(sheet, (80, 20, 0))},
    ):
        server.ok("POST", "/tables/damage/records", {"values": values})
    damage = {"name": "Damage", "kind": "database", "type": "u16", "table": "damage"}
    server.ok("POST", "/models/sheet/layers", {**damage, "resolution": 2048})
    dab(server, "/models/sheet/layers/damage", 1, 30, 70, 10)
    classes = {"mode": "categorical", "points": [{"at": 1, "color": "#ff0000"}]}
    wet = {"name": "Wet", "type": "u8", "resolution": 2048, "palette": classes}
    server.ok("POST", "/models/sheet/layers", wet)
    server.ok("POST", "/models/sheet/layers", {**wet, "name": "Hidden", "visibility": "private"})
    dots = "".join(f"{5 + i % 16 * 6},{5 + i // 16 * 6},0,{i + 1}\n" for i in range(MANY))
    server.ok(
        "POST",
        "/models/sheet/layers/wet/readings?radius_mm=2",
        "x,y,z,value\n" + dots,
        headers={"Content-Type": "text/csv"},
    )
    thread = server.ok(
        "POST",
        "/models/sheet/comments",
        {"text": "Look here.", "position": [60, 40, 0], "layer": "damage", "record": 1},
    ).json()
    server.ok("POST", f"/comments/{thread['id']}/replies", {"text": "I see."})
    model = server.get("/models/sheet").json()
    camera = camera_from(model, (0, 0, 1), 400, 300, (0, 1, 0))
    server.ok("POST", "/models/sheet/views", {"name": "Front & center", "camera": camera})


@pytest.fixture(scope="module")
def server(server):
    make(server)
    return server


def path_of(server, address):
    assert address.startswith(server.url + "/"), address
    return "/" + address[len(server.url) :]


def document(server, address, who=None, **parameters):
    address = path_of(server, address) if address.startswith("http") else "//id" + address
    answer = (who or server).ok("GET", query(address, **parameters) if parameters else address)
    return answer.json()


def turtle(server, address):
    address = path_of(server, address) if address.startswith("http") else "//id" + address
    return server.ok("GET", address + ("&" if "?" in address else "?") + "f=turtle").body.decode()


def addresses_in(value):
    """Yields the addresses of all nodes in a document."""
    if isinstance(value, dict):
        for member, each in value.items():
            if member == "id":
                yield each
            else:
                yield from addresses_in(each)
    elif isinstance(value, list):
        for each in value:
            yield from addresses_in(each)
    elif isinstance(value, str) and value.startswith("http"):
        yield value


def crawl(server, who=None):
    """Returns all documents of the site's linked data, found by following addresses from /id."""
    start, found = f"{server.url}/id", {}
    waiting = [start]
    while waiting:
        address = waiting.pop().split("#")[0]
        if address in found or not address.startswith(start) or address.endswith("/manifest"):
            continue
        if re.search(r"/areas\.\d{2}", address):
            continue  # the many annotations of one layer differ only in their numbers
        found[address] = document(server, address, who)
        waiting.extend(addresses_in(found[address]))
    return found


def polygons_of(text):
    """Returns the rings of well-known text as lists of points."""
    return [
        numpy.array([[float(n) for n in point.split()] for point in ring.split(",")])
        for ring in re.findall(r"\(([^()]+)\)", text)
    ]


def flat_area(ring):
    """Returns the area of a closed ring in space."""
    return numpy.linalg.norm(numpy.cross(ring[:-1], ring[1:]).sum(axis=0)) / 2


def test_turtle_and_json_ld_say_the_same_everywhere(server):
    found = crawl(server)
    kinds = {path.split("/id")[1].split("/")[1] for path in found if path != f"{server.url}/id"}
    assert kinds == {"models", "projects", "tables", "comments"}
    assert len(found) > 30
    for address, content in found.items():
        graph = json_ld_graph(content)
        assert len(graph) > 2, address
        assert comparable(graph) == comparable(turtle_graph(turtle(server, address))), address


def test_the_format_follows_the_request(server):
    def asked(accept, address="//id/models/sheet"):
        return server.request("GET", address, headers={"Accept": accept} if accept else {})

    for accept, kind in (
        ("", "application/ld+json"),
        ("*/*", "application/ld+json"),
        ("application/json", "application/ld+json"),
        ("text/turtle;q=0.9, application/ld+json;q=0.5", "text/turtle"),
        ("text/html,application/xhtml+xml,*/*;q=0.8", "text/html"),
    ):
        answer = asked(accept)
        assert answer.status == 200 and answer.headers["Content-Type"].startswith(kind), accept
        assert answer.headers["Vary"] == "Accept"
        assert 'rel="alternate"; type="text/turtle"' in answer.headers["Link"]
    assert asked("application/rdf+xml").status == 406
    assert server.request("GET", "//id?f=n3").status == 406
    page = server.ok("GET", "//id/tables/damage/records/1?f=html").body.decode()
    assert "Efflorescence" in page and "<script" not in page and "&lt;script&gt;" in page


def test_addresses_stay_when_names_change(server):
    before = document(server, "/models/sheet")["id"]
    server.ok("PATCH", "/models/sheet", {"name": "Panel of 2024"})
    assert document(server, before)["_label"] == "Panel of 2024"
    server.ok("PATCH", "/models/sheet", {"name": "Sheet"})
    assert document(server, "/models/sheet")["id"] == before


def test_a_model_shows_an_object(server):
    model = document(server, "/models/sheet")
    assert model["type"] == "DigitalObject"
    assert model["created_by"]["timespan"]["end_of_the_end"] == "2024-02-29T23:59:59Z"
    seen = model["digitally_shows"][0]["represents"][0]
    panel = document(server, seen["id"])
    assert panel["type"] == "HumanMadeObject" and panel["_label"] == "Panel"
    assert {"type": "Name", "content": "Panel"} in panel["identified_by"]
    assert any(each["content"] == "A 12" for each in panel["identified_by"])
    shown_by = panel["representation"][0]["digitally_shown_by"][0]["id"]
    assert shown_by == model["id"]
    statements = {each["_label"]: each["content"] for each in model["referred_to_by"]}
    assert statements["Rights"] == "https://creativecommons.org/licenses/by/4.0/"
    area = next(each for each in model["dimension"] if each["_label"] == "Surface")
    assert area["value"] == pytest.approx(0.01, rel=1e-3) and area["unit"]["_label"] == "m²"


def test_a_record_is_a_condition_at_a_place(server):
    table = server.get("/tables/damage").json()["id"]
    graph = turtle_graph(turtle(server, "/tables/damage/records/1"))
    rows = graph.query(
        """PREFIX crm: <http://www.cidoc-crm.org/cidoc-crm/>
        PREFIX rdfs: <http://www.w3.org/2000/01/rdf-schema#>
        PREFIX la: <https://linked.art/ns/terms/>
        SELECT ?record ?other ?who ?place ?value WHERE {
          ?record a crm:E26_Physical_Feature ; crm:P44_has_condition ?state ;
                  crm:P156_occupies ?place ; crm:P43_has_dimension ?depth .
          ?depth rdfs:label "Depth" ; crm:P90_has_value ?value ;
                 crm:P91_has_unit [ rdfs:label "mm" ] .
          ?state a crm:E3_Condition_State ; crm:P2_has_type ?kind ;
                 crm:P35i_was_identified_by ?assessment .
          ?kind rdfs:label "Salt" ; la:equivalent ?other .
          ?assessment a crm:E14_Condition_Assessment ; crm:P14_carried_out_by ?person ;
                      crm:P34_concerned ?object .
          ?object a crm:E22_Human-Made_Object .
          ?person rdfs:label ?who . ?place a crm:E53_Place . }"""
    )
    (row,) = list(rows)
    assert str(row.record) == f"{server.url}/id/tables/{table}/records/1"
    assert (str(row.other), str(row.who), float(row.value)) == (AAT_SALT, "owner", 2.5)
    record = document(server, "/tables/damage/records/1")
    area = next(each for each in record["dimension"] if each["_label"].startswith("Area"))
    assert area["value"] == pytest.approx(math.pi * 0.01**2, rel=0.01)
    # The place leads to the annotation with its outline.
    assert document(server, record["occupies"][0]["subject_of"][0]["id"])["type"] == "Annotation"
    crack = document(server, "/tables/damage/records/2")["occupies"][0]
    assert crack["defined_by"] == "LINESTRING Z (20 50 0, 50 50 0, 50 90 0)"
    assert "has_condition" not in document(server, "/tables/damage/records/2")


def test_terms_are_concepts(server):
    graph = turtle_graph(turtle(server, "/tables/kinds"))
    rows = list(
        graph.query(
            f"""PREFIX skos: <{SKOS}> SELECT ?concept WHERE {{
            ?concept a skos:Concept ; skos:prefLabel "Salz"@de , "Salt" ; skos:notation "salt" ;
                     skos:definition "White crystals" ; skos:exactMatch <{AAT_SALT}> ;
                     skos:inScheme ?scheme . ?scheme a skos:ConceptScheme ;
                     skos:hasTopConcept ?concept . }}"""
        )
    )
    assert len(rows) == 1
    concept = document(server, str(rows[0].concept))
    assert concept["notation"] == "salt"


def test_annotations_have_places_in_the_scene(server):
    """The scene has its origin at the origin of the model, +y up, and meters. This model has its
    own +y up, so its axes are those of the scene."""
    model = server.get("/models/sheet").json()
    origin = numpy.array(model["origin"]) / 1000
    page = document(server, "/models/sheet/layers/damage/annotations")
    by_name = {each["id"].rsplit("/", 1)[1]: each for each in page["items"]}
    assert set(by_name) == {"areas.1", "lines_crack.2-1", "points_sample.3-1"}

    def selector(name):
        return by_name[name]["target"]["selector"][0]

    ring = polygons_of(selector("areas.1")["value"])[0]
    assert selector("areas.1")["type"] == "WktSelector"
    assert flat_area(ring) == pytest.approx(math.pi * 0.01**2, rel=0.01)
    center = (ring[:-1].max(axis=0) + ring[:-1].min(axis=0)) / 2 + origin
    assert center == pytest.approx([0.03, 0.07, 0], abs=1e-4)
    line = polygons_of(selector("lines_crack.2-1")["value"])[0] + origin
    assert line == pytest.approx(numpy.array([[20, 50, 0], [50, 50, 0], [50, 90, 0]]) / 1000)
    point = selector("points_sample.3-1")
    assert point["type"] == "PointSelector"
    assert numpy.array([point[a] for a in "xyz"]) + origin == pytest.approx([0.08, 0.02, 0])
    table = server.get("/tables/damage").json()["id"]
    bodies = by_name["areas.1"]["body"]
    assert bodies[0]["id"] == f"{server.url}/id/tables/{table}/records/1"
    assert bodies[1]["value"] == "Efflorescence" and bodies[1]["purpose"] == "tagging"
    for each in by_name.values():
        for other in each["seeAlso"]:
            answer = server.request("GET", path_of(server, other["id"]))
            assert answer.status == 200, other
    alone = document(server, by_name["areas.1"]["id"])
    assert alone["target"] == by_name["areas.1"]["target"]
    assert (
        server.request("GET", "//id/models/sheet/layers/damage/annotations/areas.9").status == 404
    )


def test_comments_are_annotations(server):
    page = document(server, "/models/sheet/comments")
    thread, reply = page["items"]
    assert (thread["motivation"], reply["motivation"]) == ("commenting", "replying")
    assert thread["body"]["value"] == "Look here." and thread["creator"]["name"] == "owner"
    assert reply["target"] == thread["id"]
    assert document(server, thread["id"])["target"] == thread["target"]
    motives = {str(each) for each in turtle_graph(turtle(server, thread["id"])).objects()}
    assert OA + "commenting" in motives


def test_pages_lead_through_all_annotations(server):
    collection = document(server, "/models/sheet/annotations")
    assert collection["type"] == "AnnotationCollection"
    page, met = document(server, collection["first"]["id"]), []
    previous = None
    while True:
        met += [each["id"] for each in page["items"]]
        assert page["partOf"]["id"] == collection["id"]
        assert len(page["items"]) <= 200
        if "prev" in page:
            assert page["prev"]["id"] == previous
        if "next" not in page:
            break
        previous = page["id"]
        page = document(server, page["next"]["id"])
    assert len(met) == len(set(met)) == 2 + 3 + MANY
    assert document(server, "/models/sheet/comments", page=9)["items"] == []
    for wrong in ("x", "-1", "10000000"):
        assert server.request("GET", f"//id/models/sheet/comments?page={wrong}").status == 422


def scene_points(content):
    """Returns the vertices of a GLB file in its scene."""
    length = int.from_bytes(content[12:16], "little")
    description = json.loads(content[20 : 20 + length])
    node = next(each for each in description["nodes"] if "mesh" in each)
    matrix = numpy.array(node["matrix"]).reshape(4, 4).T
    accessor = description["accessors"][
        description["meshes"][0]["primitives"][0]["attributes"]["POSITION"]
    ]
    view = description["bufferViews"][accessor["bufferView"]]
    at = 28 + length + view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", 12)
    raw = numpy.frombuffer(content, numpy.uint8)[at : at + stride * accessor["count"]]
    raw = numpy.resize(raw, stride * accessor["count"]).reshape(-1, stride)[:, :12]
    points = numpy.frombuffer(raw.tobytes(), numpy.float32).reshape(-1, 3)
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def test_the_manifest_is_a_scene_with_the_surface_and_cameras(server):
    manifest = document(server, "/models/sheet/manifest")
    assert manifest["@context"] == "http://iiif.io/api/presentation/4/context.json"
    assert manifest["rights"].startswith("http://creativecommons.org")
    scene, canvas = manifest["items"]
    assert (scene["type"], canvas["type"]) == ("Scene", "Canvas")
    assert scene["spatialScale"] == {"type": "Quantity", "quantityValue": 1.0, "unit": "m"}
    surface, camera = scene["items"][0]["items"]
    body = surface["body"]
    moved = numpy.zeros(3)
    if body["type"] == "SpecificResource":
        (transform,) = body["transform"]
        moved = numpy.array([transform[axis] for axis in "xyz"])
        body = body["source"]
    assert (body["type"], body["format"]) == ("Model", "model/gltf-binary")
    content = server.ok("GET", path_of(server, body["id"])).body
    points = scene_points(content) + moved
    low, high = points.min(axis=0), points.max(axis=0)
    model = server.get("/models/sheet").json()
    origin = numpy.array(model["origin"])
    assert low == pytest.approx((numpy.array([0, 0, 0]) - origin) / 1000, abs=1e-5)
    assert high == pytest.approx((numpy.array([100, 100, 0]) - origin) / 1000, abs=1e-5)
    # The point of the comment is on the surface.
    target = document(server, "/models/sheet/comments")["items"][0]["target"]["selector"][0]
    place_of_comment = numpy.array([target[axis] for axis in "xyz"])
    assert numpy.linalg.norm(points - place_of_comment, axis=1).min() < 0.004
    # The camera sees the middle of the sheet from the front.
    assert camera["body"]["type"] == "PerspectiveCamera"
    saved = server.get("/models/sheet/views").json()["views"][0]["camera"]
    vertical = math.degrees(2 * math.atan(1 / saved["projection"][5]))
    assert camera["body"]["fieldOfView"] == pytest.approx(vertical)
    eye = numpy.array([camera["target"]["selector"][0][axis] for axis in "xyz"])
    view = numpy.array(saved["view"]).reshape(4, 4).T
    expected = (numpy.linalg.inv(view)[:3, 3] - origin) / 1000
    assert eye == pytest.approx(expected)
    look = numpy.array([camera["body"]["lookAt"][axis] for axis in "xyz"])
    assert look == pytest.approx((low + high) / 2, abs=1e-3)
    picture = canvas["items"][0]["items"][0]["body"]
    answer = server.ok("GET", path_of(server, picture["id"]))
    assert answer.headers["Content-Type"] == picture["format"]
    ids = [each for each in addresses_in(manifest) if each.startswith(server.url + "/id")]
    for page in manifest["annotations"]:
        assert document(server, page["id"])["type"] == "AnnotationPage"
    assert manifest["id"] in ids


def test_without_the_surface_the_scene_has_the_cameras(server):
    viola = Someone(server, "viola", "viewer")
    scene, canvas = document(server, "/models/sheet/manifest", viola)["items"]
    assert [scene["type"], canvas["type"]] == ["Scene", "Canvas"]
    (camera,) = scene["items"][0]["items"]
    assert camera["body"]["type"] == "PerspectiveCamera"


def test_a_table_lists_its_records_on_pages(server):
    server.ok("POST", "/projects/default/tables", {"name": "Finds", "columns": [{"name": "Name"}]})
    rows = "name\n" + "".join(f"find {i}\n" for i in range(10_001))
    server.ok("POST", "/tables/finds/records", rows, headers={"Content-Type": "text/csv"})
    first = document(server, "/tables/finds")
    assert len(first["has_part"]) == 10_000 and "previous" not in first
    last = document(server, first["next"])
    assert last["has_part"] == [first["id"] + "/records/10001"]
    assert last["previous"] == first["id"] and "next" not in last
    assert "hydra:next" in turtle(server, "/tables/finds")
    assert server.request("GET", "//id/tables/finds?page=-1").status == 422
    server.ok("DELETE", "/tables/finds")


def test_a_surface_is_a_valid_glb(server):
    content = server.ok(
        "GET", "/models/sheet/surface.glb?layers=damage&texture_size=1024&max_triangles=500"
    )
    assert int(content.headers["Strata-Triangles"]) <= 500
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "surface.glb")
        with open(path, "wb") as file:
            file.write(content.body)
        assert glb.validate(path)["issues"]["numErrors"] == 0
    for wrong in ("layers=nothing", "texture_size=5", "max_triangles=1", "max_triangles=x"):
        assert server.request("GET", f"/models/sheet/surface.glb?{wrong}").status in (404, 422)


def test_everybody_sees_only_what_the_role_allows(server):
    someone = Someone(server, "vera", "viewer")
    found = crawl(server, someone)
    text = json.dumps(found)
    assert "Efflorescence" in text and "grave" not in text and "Hidden" not in text
    assert "grave" in json.dumps(document(server, "/tables/damage/records/1"))
    manifest = document(server, "/models/sheet/manifest", someone)
    assert "surface.glb" not in json.dumps(manifest)
    assert someone.status("GET", "/models/sheet/surface.glb") == 403
    assert "access_point" not in document(server, "/models/sheet", someone)
    assert (
        server.request("GET", "//id/models/sheet", headers={"Authorization": "Bearer x"}).status
        == 401
    )
