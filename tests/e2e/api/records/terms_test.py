"""Lists of terms over HTTP: import and export as CSV and SKOS, search in the tree, painting in the
terms' colors, and refusals of hostile files. The file also tests templates, which make tables and
layers together."""
import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid

CSV, TURTLE, XML = (
    {"Content-Type": kind}
    for kind in ("text/csv", "text/turtle; charset=utf-8", "application/rdf+xml")
)
PROJECT, LIST = "/projects/default", "/tables/stone"

STONE = """code,parent,label,label-es,definition,color,pattern
loss,,Loss,Pérdida,"What is missing, is missing.",#CC79A7,solid
worn,loss,Worn,Desgaste,,,hatch
broken-off,loss,Broken off,Rotura,,,solid
deposit,,On the surface,Depósito,,#07b,dots
salt,deposit,Salts,Sales,,#56b4e9,dots
"""
PREFIXES = (
    "@prefix skos: <http://www.w3.org/2004/02/skos/core#> . @prefix t: <https://t.example/> .\n"
)


def tree(server, query=""):
    return [
        (each["depth"], each["name"])
        for each in server.ok("GET", f"{LIST}/terms{query}").json()["terms"]
    ]


@pytest.fixture(scope="module", autouse=True)
def camera(server):
    model = server.import_model(folded_grid(), "wall.ply", unit="mm", name="Wall")
    return camera_from(model, (0, 0, 1), up=(0, 1, 0))


def test_import_csv(server):
    dry = server.ok(
        "POST", PROJECT + "/terms?name=Stone&dry_run=true", STONE.encode(), headers=CSV
    ).json()
    assert (
        dry["created"] == 5
        and "table" not in dry
        and server.get(PROJECT + "/tables").json()["total"] == 0
    ), dry
    keyed = {**CSV, "Idempotency-Key": "stone"}
    made = server.ok("POST", PROJECT + "/terms?name=Stone", STONE.encode(), headers=keyed)
    assert made.status == 201 and made.headers["Location"] == "/api/v1" + LIST
    report = made.json()
    assert (report["rows"], report["created"], report["sequence"], report["table"]["kind"]) == (
        5,
        5,
        1,
        "terms",
    ), report
    again = server.ok("POST", PROJECT + "/terms?name=Stone", STONE.encode(), headers=keyed)
    assert again.json() == report and server.get(PROJECT + "/tables").json()["total"] == 1
    taken = server.post(PROJECT + "/terms?name=STONE", STONE.encode(), headers=CSV)
    assert taken.status == 409 and "`stone`" in taken.json()["detail"], taken
    assert tree(server) == [
        (0, "Loss"),
        (1, "Worn"),
        (1, "Broken off"),
        (0, "On the surface"),
        (1, "Salts"),
    ]
    assert server.get(LIST + "/terms?lang=" + "a" * 36).status == 422
    assert tree(server, "?lang=es-MX")[0] == (0, "Pérdida") and tree(server, "?lang=de")[0] == (
        0,
        "Loss",
    )
    assert tree(server, "?q=ROTURA") == [
        (0, "Loss"),
        (1, "Broken off"),
    ], "words are looked for in all languages, and those above are told"
    assert (
        tree(server, "?q=deposito") == [(0, "On the surface")] and tree(server, "?q=nothing") == []
    )
    page = server.ok("GET", LIST + "/terms?limit=2&offset=1").json()
    assert [each["code"] for each in page["terms"]] == ["worn", "broken-off"] and page["total"] == 5
    worn = page["terms"][0]
    assert (
        worn["parent"] == 1
        and worn["match"]
        and worn["pattern"] == "hatch"
        and worn["color"] not in ("#cc79a7", "")
    ), worn


def test_import_again(server):
    """A second import changes terms by code, keeps their keys and adds a language. It is one undo
    step."""
    text = (
        "code,label,label-de,parent\nsalt,Salt crystals,Salze,deposit\npitted,Pitted,Narbig,loss\n"
    )
    report = server.ok("POST", LIST + "/terms", text.encode(), headers=CSV).json()
    assert (report["created"], report["changed"], report["unchanged"]) == (1, 1, 0), report
    salt = server.ok("GET", LIST + "/terms?q=salt").json()["terms"][1]
    assert (salt["key"], salt["label"], salt["labels"], salt["color"]) == (
        5,
        "Salt crystals",
        {"de": "Salze", "es": "Sales"},
        "#56b4e9",
    ), salt
    same = server.ok("POST", LIST + "/terms", text.encode(), headers=CSV).json()
    assert (same["unchanged"], same["sequence"]) == (2, 0), same
    server.ok("POST", LIST + "/undo")
    assert len(tree(server)) == 5 and not [
        each
        for each in server.get(LIST + "/columns").json()["columns"]
        if each["slug"] == "label-de"
    ]
    server.ok("POST", LIST + "/redo")
    for text, line, title in [
        ("code,parent\nloss,worn\n", 2, "Circular hierarchy of terms"),
        ("code,parent\nloss,\nx,y\n", 3, "Parent not found"),
        ("code,color\nloss,\nx,red\n", 3, "Invalid color"),
        ("code\na\na\n", 3, "Duplicate code"),
    ]:
        refused = server.post(LIST + "/terms", text.encode(), headers=CSV)
        problems = refused.json()["rows"]["problems"]
        assert refused.status == 422 and (problems[0]["line"], problems[0]["title"]) == (
            line,
            title,
        ), refused
        dry = server.ok("POST", LIST + "/terms?dry_run=true", text.encode(), headers=CSV).json()
        assert dry["problems"] == problems and dry["dry_run"]
    assert len(tree(server)) == 6
    # the server lists and reports a cycle that was made by hand, and does not hide the terms of the
    # cycle
    server.ok("PATCH", LIST + "/records/1", {"values": {"parent": 2}})
    assert server.ok("GET", LIST + "/columns/parent/cycles").json()["cycles"] == [[1, 2]]
    assert len(tree(server)) == 6
    server.ok("POST", LIST + "/undo")


def test_skos(server):
    turtle = server.ok("GET", LIST + "/terms?f=turtle")
    assert (
        turtle.headers["Content-Type"].startswith("text/turtle") and b"skos:broader" in turtle.body
    ), turtle
    text = server.ok("GET", LIST + "/terms?f=csv&separator=semicolon").body
    assert server.get(LIST + "/terms?f=csv&limit=0").json()["field"] == "limit"
    assert text.startswith(b"\xef\xbb\xbfcode;parent;label;label-de;label-es;"), text
    for name, body, headers in (("By SKOS", turtle.body, TURTLE), ("By CSV", text, CSV)):
        made = server.ok(
            "POST", PROJECT + "/terms?name=" + name.replace(" ", "%20"), body, headers=headers
        ).json()
        terms = server.ok("GET", f"/tables/{made['table']['slug']}/terms?lang=es").json()["terms"]
        first = server.ok("GET", LIST + "/terms?lang=es").json()["terms"]
        assert sorted(
            (each["code"], each["name"], each["depth"], each["definition"]) for each in terms
        ) == sorted(
            (each["code"], each["name"], each["depth"], each["definition"]) for each in first
        )
    xml = """<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:skos="http://www.w3.org/2004/02/skos/core#">
      <skos:Concept rdf:about="https://t.example/a"><skos:prefLabel xml:lang="en">A</skos:prefLabel></skos:Concept></rdf:RDF>"""
    made = server.ok("POST", PROJECT + "/terms?name=Letters", xml.encode(), headers=XML).json()
    letters = f"/tables/{made['table']['slug']}"
    # Matches terms by URI: the code changes and the key remains. A second preferred label in a
    # language and a second broader term are counted.
    more = (
        PREFIXES
        + """t:a a skos:Concept ; skos:notation "alpha" ; skos:prefLabel "A"@en, "Ah"@en .
      t:b a skos:Concept ; skos:broader t:a, t:elsewhere ."""
    )
    report = server.ok("POST", letters + "/terms", more.encode(), headers=TURTLE).json()
    assert (report["changed"], report["created"], report["left_out"]) == (1, 1, 2), report
    terms = server.ok("GET", letters + "/terms").json()["terms"]
    assert [(each["key"], each["code"], each["name"], each["uri"]) for each in terms] == [
        (1, "alpha", "A", "https://t.example/a"),
        (2, "b", "b", "https://t.example/b"),
    ], terms


def test_hostile(server):
    name = PROJECT + "/terms?name=Bad"
    entity = '<!DOCTYPE r [<!ENTITY a "%s">%s]>' % (
        "a" * 1000,
        "".join(f'<!ENTITY {chr(98 + n)} "{("&" + chr(97 + n) + ";") * 10}">' for n in range(9)),
    )
    head = '<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#" xmlns:s="http://www.w3.org/2004/02/skos/core#">'
    for what, path, body, headers, status in [
        (
            "an entity that grows",
            name,
            entity + head + "<s:Concept><s:prefLabel>&j;</s:prefLabel></s:Concept></rdf:RDF>",
            XML,
            422,
        ),
        (
            "a file in an entity",
            name,
            '<!DOCTYPE r [<!ENTITY a SYSTEM "file:///etc/passwd">]>'
            + head
            + "<s:Concept>&a;</s:Concept></rdf:RDF>",
            XML,
            422,
        ),
        ("nested elements", name, head + "<s:Concept><s:broader>" * 50_000, XML, 422),
        (
            "nested blank nodes",
            name,
            PREFIXES + "t:a skos:broader " + "[ skos:broader " * 100_000,
            TURTLE,
            422,
        ),
        (
            "a huge literal",
            name,
            PREFIXES + 't:a a skos:Concept ; skos:definition "%s" .' % ("x" * 1_000_000),
            TURTLE,
            422,
        ),
        (
            "a circle",
            name,
            PREFIXES + "t:a a skos:Concept ; skos:broader t:b . t:b skos:broader t:a .",
            TURTLE,
            422,
        ),
        (
            "Turtle that ends too early",
            name,
            PREFIXES + 't:a a skos:Concept ; skos:prefLabel "a',
            TURTLE,
            422,
        ),
        ("no concept", name, PREFIXES + "t:a t:b t:c .", TURTLE, 422),
        ("nothing", name, "", TURTLE, 422),
        ("not UTF-8", name, b"\xff\xfe\x00", TURTLE, 422),
        ("another type", name, "code\na\n", {"Content-Type": "application/json"}, 415),
        (
            "an address that runs",
            name,
            PREFIXES + "<javascript:alert(1)> a skos:Concept .",
            TURTLE,
            422,
        ),
        ("no name", PROJECT + "/terms", "code\na\n", CSV, 422),
        ("a project that is not there", "/projects/nowhere/terms?name=x", "code\na\n", CSV, 404),
        ("a table that is not there", "/tables/nowhere/terms", "code\na\n", CSV, 404),
    ]:
        answer = server.post(
            path, body.encode() if isinstance(body, str) else body, headers=headers
        )
        assert answer.status == status, f"{what}: {answer}"
    plain = server.ok(
        "POST", PROJECT + "/tables", {"name": "Plain", "columns": [{"name": "Code"}]}
    ).json()
    assert plain["kind"] == "records"
    assert (
        server.get("/tables/plain/terms").status == 409
        and server.post("/tables/plain/terms", b"code\na\n", headers=CSV).status == 409
    )
    assert server.get(LIST + "/terms?f=xlsx").status == 406
    names = [each["name"] for each in server.get(PROJECT + "/tables").json()["tables"]]
    assert "Bad" not in names, names


def test_colours(server, camera):
    """A layer of terms has the terms' colors and follows their changes, as long as it has no
    palette of its own."""
    layer = server.ok(
        "POST",
        "/models/wall/layers",
        {"name": "Stone", "kind": "database", "type": "u16", "table": "stone"},
    ).json()
    legend = {point["label"]: (point["at"], point["color"]) for point in layer["palette"]["points"]}
    assert (
        legend["Loss"] == (1, "#cc79a7ff")
        and legend["Salt crystals"] == (5, "#56b4e9ff")
        and len(legend) == 6
    ), legend
    server.ok(
        "POST",
        "/models/wall/layers/stone/edits",
        {"op": "stroke", "camera": camera, "radius_px": 40, "path": [[320, 240]], "value": 1},
    )
    for path in ("/models/wall/layers/stone", LIST):
        for query, name in (
            ("", "Loss"),
            ("lang=es", "Pérdida"),
            ("lang=ES-MX&f=csv", "Pérdida"),
            ("lang=de", "Loss"),
        ):
            told = server.ok("GET", f"{path}/quantities?{query}").body.decode("utf-8-sig")
            assert name in told and "loss" not in told, (path, query, told)
    etag = server.get("/models/wall/layers/stone").headers["ETag"]
    with LiveClient(server, "wall") as live:
        live.send({"op": "hello", "client": "test", "dpr": 1, "accept": ["jpeg"]})
        live.receive_until("welcome")
        server.ok("PATCH", LIST + "/records/1", {"values": {"color": "#102030"}})
        told = live.receive_until("layer")
        assert told["layer"]["palette"]["points"][0]["color"] == "#102030ff", told
    now = server.ok("GET", "/models/wall/layers/stone")
    assert (
        now.json()["palette"]["points"][0]["color"] == "#102030ff" and now.headers["ETag"] != etag
    ), now
    # renaming the layer does not change this, but a separate palette does
    server.ok("PATCH", "/models/wall/layers/stone", {"name": "Stone now"})
    server.ok("PATCH", LIST + "/records/1", {"values": {"color": "#405060"}})
    assert (
        server.get("/models/wall/layers/stone").json()["palette"]["points"][0]["color"]
        == "#405060ff"
    )
    own = {"mode": "categorical", "points": [{"at": 1, "color": "#ff0000"}]}
    server.ok("PATCH", "/models/wall/layers/stone", {"palette": own})
    server.ok("PATCH", LIST + "/records/1", {"values": {"color": "#708090"}})
    assert len(server.get("/models/wall/layers/stone").json()["palette"]["points"]) == 1
    server.ok(
        "PATCH", "/models/wall/layers/stone", {"palette": {"mode": "categorical", "points": []}}
    )
    assert (
        server.get("/models/wall/layers/stone").json()["palette"]["points"][0]["color"]
        == "#708090ff"
    )


def test_templates(server):
    known = server.ok("GET", "/templates").json()
    assert [each["slug"] for each in known["templates"]] == [
        "excavation-units",
        "stone-condition",
        "treatment",
        "wall-painting",
    ]
    keyed = {"Idempotency-Key": "template"}
    use = {"model": "wall", "language": "es"}
    made = server.ok("POST", PROJECT + "/templates/stone-condition", use, headers=keyed).json()
    assert [each["name"] for each in made["tables"]] == [
        "Términos del estado de la piedra",
        "Materiales de la piedra",
        "Medidas en la piedra",
        "Observaciones de la piedra",
    ], made
    assert [each["name"] for each in made["layers"]] == [
        "Estado de la piedra",
        "Material de la piedra",
        "Medidas en la piedra",
        "Observaciones de la piedra",
    ]
    assert all(each["visible"] for each in made["layers"])
    assert made["layers"][0]["labels"] == {
        "en": "Stone condition",
        "de": "Zustand des Steins",
        "es": "Estado de la piedra",
    }, made["layers"][0]
    layer = "/models/wall/layers/" + made["layers"][0]["slug"]
    for what, body, field in [
        ("a language that is none", {"labels": {"es_MX": "Piedra"}}, "labels"),
        ("a description in none", {"descriptions": {"": "Lo que sufre"}}, "descriptions"),
    ]:
        refused = server.request("PATCH", layer, body)
        assert refused.status == 422 and refused.json()["field"].startswith(
            field
        ), f"{what}: {refused}"
    words = {"labels": {"fr": "État"}, "descriptions": {"fr": "Ce que souffre la pierre"}}
    assert words.items() <= server.ok("PATCH", layer, words).json().items()
    assert words.items() <= server.ok("GET", layer).json().items()
    again = server.ok("POST", PROJECT + "/templates/stone-condition", use, headers=keyed).json()
    assert [each["id"] for each in again["layers"]] == [each["id"] for each in made["layers"]]
    terms = server.ok("GET", "/tables/stone-condition-terms/terms?q=flaking").json()["terms"]
    assert [each["label"] for each in terms] == [
        "Desprendimiento",
        "Desplacado",
        "Descamación",
    ] and terms[2]["labels"]["en"] == "Flaking", terms
    # after the columns that every term list has, this list has columns for drawing
    kinds = [
        (each["name"], each["kind"])
        for each in server.ok("GET", "/tables/stone-condition-terms/columns").json()["columns"]
    ]
    assert kinds[-2:] == [("Líneas", "line"), ("Puntos", "point")], kinds
    assert server.get("/tables/stone-condition-terms").json()["kind"] == "terms"
    columns = server.ok("GET", "/tables/stone-observations/columns").json()["columns"]
    assert (columns[0]["slug"], columns[0]["name"], columns[0]["target"]) == (
        "term",
        "Término",
        made["tables"][0]["id"],
    ), columns[0]
    assert made["layers"][0]["palette"]["points"][1]["label"] == "Grieta"
    tables, layers = (
        server.get(PROJECT + "/tables").json()["total"],
        server.get("/models/wall/layers").json()["total"],
    )
    for what, path, body, status in [
        ("names that are taken", "stone-condition", use, 409),
        ("no such template", "nothing", {}, 404),
        ("no such model", "treatment", {"model": "nowhere"}, 422),
        ("a language that is none", "treatment", {"language": "?"}, 422),
    ]:
        answer = server.post(f"{PROJECT}/templates/{path}", body)
        assert answer.status == status, f"{what}: {answer}"
    # the layer's name is in use and the names of the tables are free, so nothing is created
    server.ok("POST", "/models/wall/layers", {"name": "treatments"})
    refused = server.post(PROJECT + "/templates/treatment", {"model": "wall"})
    assert refused.status == 409 and "Rename or delete" in refused.json()["detail"], refused
    assert (
        server.get(PROJECT + "/tables").json()["total"],
        server.get("/models/wall/layers").json()["total"],
    ) == (tables, layers + 1)
    for name, count in [("treatment", 2), ("excavation-units", 2), ("wall-painting", 4)]:
        made = server.ok("POST", f"{PROJECT}/templates/{name}", {}).json()
        assert made["layers"] == [] and len(made["tables"]) == count
    units = {
        each["slug"]: each for each in server.ok("GET", "/tables/units/columns").json()["columns"]
    }
    assert units["above"]["target"] == server.get("/tables/units").json()["id"]
    server.ok("POST", "/tables/units/records", {"values": {"code": "SU 1", "kind": 1}})


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
