"""A site with private content, and attempts to see it with every query and every address of the
contract."""
import io
import re
import struct
import urllib.parse
import zipfile

from support.addresses import query
from support.cameras import camera_from
from support.contract import address_of
from support.meshes import folded_grid
from support.pictures import png

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
VALUE = 48611.5  # the value painted on the secret layer
LAYER, KEYS, COLUMN, CELL, FILE, CRACK = (
    "tomb-q7x",
    "bones-q5v",
    "hoard-q8y",
    "gold-q9z",
    "relic-q6w.png",
    "secret-q3u",
)
MARKS = [
    mark.encode()
    for mark in (
        LAYER,
        "tomb q7x",
        KEYS,
        "bones q5v",
        COLUMN,
        "hoard q8y",
        CELL,
        FILE,
        CRACK,
        "secret q3u",
        str(VALUE),
    )
] + [struct.pack("<f", VALUE)]
# the texts have the same length, because messages count characters
GHOSTS = {LAYER: "tomb-zzz", KEYS: "bones-zzz", COLUMN: "hoard-zzz"}
PNG = png(8, 8, lambda x, y: (200, 100, 50))
JSON_CHANGES = ("post", "put", "patch")


def leaks(body):
    """Returns the secret texts in a response. Also searches in workbooks."""
    if body.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(body)) as book:
            body = b"".join(book.read(name) for name in book.namelist())
    plain = body.lower()
    return [mark for mark in MARKS if mark.lower() in plain]


def make_site(server):
    model = server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    camera = camera_from(model, (0, 0, 1), up=(0, 1, 0))
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    columns = [
        {"name": "Name"},
        {"name": "Depth", "kind": "numeric"},
        {"name": "Photo", "kind": "picture"},
        {"name": "Edge", "kind": "line"},
    ]
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Finds", "kind": "database", "type": "u16", "columns": columns},
    )
    server.ok(
        "POST",
        "/tables/finds/records",
        {"records": [{"values": {"name": f"Find {n}", "depth": n}} for n in (1, 2)]},
    )
    public = server.ok(
        "POST", query("/tables/finds/records/1/attachments", name="plan.png"), PNG
    ).json()["attachments"][0]
    for layer, value in (("cracks", 3), ("finds", 1)):
        # a small area, because the test reads every texel many times
        server.ok(
            "POST",
            f"{M}/layers/{layer}/edits",
            {"op": "fill", "mode": "where", "where": "x < 5", "value": value},
        )
    before = server.ok("POST", M + "/frame", {"camera": camera, "format": "png"}).body
    # private from the start
    secret = {"visibility": "private"}
    server.ok("POST", M + "/layers", {"name": "Tomb q7x", "type": "f32", **secret})
    server.ok(
        "POST",
        f"{M}/layers/{LAYER}/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": VALUE},
    )
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Bones q5v", "kind": "database", "type": "u16", "table": "finds", **secret},
    )
    server.ok(
        "POST",
        f"{M}/layers/{KEYS}/edits",
        {"op": "fill", "mode": "where", "where": f'"{LAYER}" > 0', "value": 2},
    )
    server.ok("POST", "/tables/finds/columns", {"name": "Hoard q8y", **secret})
    server.ok("POST", "/tables/finds/columns", {"name": "Secret q3u", "kind": "line", **secret})
    line = [{"model": model["id"], "coordinates": [[10, 10, 0], [90, 90, 0]]}]
    server.ok("PATCH", "/tables/finds/records/1", {"values": {COLUMN: CELL, CRACK: line}})
    hidden = server.ok(
        "POST",
        query(
            "/tables/finds/records/1/attachments", name=FILE, column="photo", visibility="private"
        ),
        PNG,
    ).json()["attachments"][0]
    thread = server.ok(
        "POST",
        M + "/comments",
        {"text": f"{CELL} lies here", "position": [50, 50, 0], "layer": LAYER},
    ).json()["id"]
    server.ok("POST", f"/comments/{thread}/replies", {"text": f"Much {CELL}?"})
    column_shown = {"layer": "finds", "highlight": {"filter": f"\"{COLUMN}\" = '{CELL}'"}}
    server.ok(
        "POST",
        M + "/views",
        {
            "name": "Plan",
            "camera": camera,
            "layers": [{"layer": LAYER, "opacity": 0.5}, column_shown],
        },
    )
    stop = {
        "view": "plan",
        "title": {"en": "Here"},
        "layers": [LAYER],
        "records": [
            {"table": "finds", "keys": [1], "columns": [{"column": COLUMN}, {"column": "name"}]}
        ],
    }
    server.ok("POST", M + "/tours", {"name": "Round", "languages": ["en"], "stops": [stop]})
    server.ok("POST", query(M + "/tours/round/files", name="plan.png"), PNG)
    server.ok("POST", M + "/tours/round/kiosks", {"name": "Hall"})
    server.ok("POST", M + "/snapshots", {"name": "First"})
    server.ok(
        "POST",
        M + "/selections",
        {"name": "Sunny", "audience": "everyone", "within": {"where": "true"}},
    )
    assert hidden["visibility"] == "private" and public["visibility"] == "public"
    return camera, before, public, hidden, thread


def words(server, public):
    """Returns values for the parameters of paths, only of public objects."""
    job = server.get("/jobs").json()["jobs"][0]["id"]
    look = server.get(M + "/looks").json()["looks"]
    return {
        "project": ["default"],
        "model": ["sheet"],
        "layer": ["cracks", "finds"],
        "table": ["finds"],
        "key": ["1"],
        "column": ["name", "depth", "photo"],
        "attachment": [str(public["id"])],
        "job": [str(job)],
        "look": [each["slug"] for each in look] or ["1"],
        "comment": ["1"],
        "view": ["plan"],
        "tour": ["round"],
        "snapshot": ["first"],
        "selection": ["sunny"],
        "photograph": ["1"],
        "collection": ["sheet", "sheet.cracks", "sheet.finds", "sheet.finds.name"],
        "feature": ["1"],
        "annotation": ["areas.1"],
        "plane": ["xy"],
        "file": ["1"],
        "kiosk": ["1"],
        "name": ["sheet.ply"],
        "format": ["npy", "png", "tif"],
        "tool": ["1"],
        "template": ["1"],
        "user": ["owner"],
        "group": ["1"],
        "object": ["1"],
        "bill": ["1"],
        "entry": ["layer-1"],
        "session": ["1"],
        "token": ["1"],
    }


def fillings(path, words_of):
    """Returns the path with each of the words in place of its parameters."""
    parameter = re.search(r"\{(\w+)\}", path)
    if not parameter:
        return [path]
    return [
        filled
        for word in words_of[parameter[1]]
        for filled in fillings(path.replace(parameter[0], word, 1), words_of)
    ]


def queries(server, path, operation):
    """Yields an empty query, then each parameter with each value from the contract."""
    parameters = [
        server.contract._resolve(each)
        for each in operation.get("parameters", [])
        + server.contract.document["paths"][path].get("parameters", [])
    ]
    parameters = [each for each in parameters if each["in"] == "query"]
    given = {
        "coords": ["POINT Z(50 50 0)"],
        "datetime": ["2030-01-01T00:00:00Z", "2030-01-01T00:00:00Z/.."],
        "bbox": ["0,0,0.1,0.1"],
        "subset": ["x(0:0.1)"],
        "scale-size": ["x(50),y(50)"],
        "width": ["20"],
        "filter": ["depth > 0"],
        "sortby": ["name", "-depth"],
        "at": ["1", "2"],
        "where": ["cracks > 0"],
        "include": ["pieces,perimeter,quantiles"],
        "cell": ["20mm"],
        "columns": ["name,depth"],
        "key": ["1"],
        "layer": ["cracks", "finds"],
        "layers": ["cracks"],
        "parameter-name": ["cracks,finds"],
        "project": ["default"],
    }
    given["coords"] = {
        "get_ogc_trajectory": ["LINESTRING(0.01 0.01, 0.09 0.09)"],
        "get_ogc_area": ["POLYGON((0.01 0.01, 0.09 0.01, 0.09 0.09, 0.01 0.01))"],
    }.get(operation["operationId"], given["coords"])
    values = {
        each["name"]: given.get(each["name"])
        or [str(value) for value in server.contract._resolve(each["schema"]).get("enum", [])]
        for each in parameters
    }
    base = {
        each["name"]: values[each["name"]][0]
        for each in parameters
        if each.get("required") and values[each["name"]]
    }
    yield base
    for name, choices in values.items():
        for choice in choices:
            yield {**base, name: choice}


def reading_bodies(camera):
    """Queries that have a body."""
    line = {"places": [[5, 5, 0], [95, 95, 0]], "step_mm": 5}
    return {
        "positions": [{"points": [[50, 50, 0]]}],
        "layer_difference": [{"from": 1}, {"from": 1, "to": 2}],
        "measure_section": [{"section": [[0, 0, -1, 0.0005]]}],
        "pick": [{"camera": camera, "x": 300, "y": 200}],
        "profile": [line],
        "select": [
            {"where": "cracks > 0", "layers": ["cracks", "finds"]},
            {"changed": {"from": 0}},
            {"changed": {"from": 0, "layers": ["cracks"]}},
        ],
        "cross_table": [{"rows": "finds", "columns": "cracks"}],
        "frame": [
            {"camera": camera, "format": "png"},
            {"camera": camera, "format": "png", "at": 2},
        ],
        "record_extent": [{"filter": "depth > 0"}],
        "make_figure": [
            {"format": "svg", "dpi": 50},
            {"format": "svg", "dpi": 50, "view": "plan"},
            {"format": "svg", "dpi": 50, "labels": {"layer": "finds", "column": "name"}},
            {
                "format": "svg",
                "dpi": 50,
                "rollout": {"axis": {"point": [50, 50, -60], "direction": [0, 1, 0]}},
            },
        ],
        "export_model": [
            {"texture_size": 512, "texture_format": "png"},
            {"texture_size": 512, "features": "finds"},
            {"texture_size": 512, "features": "cracks", "at": 2},
        ],
        "make_report": [
            {"figures": [], "record_pictures": False, "format": "docx"},
            {"figures": [{"view": "plan"}], "record_pictures": False, "format": "pdf"},
        ],
        "rollout": [
            {"axis": {"point": [50, 50, -60], "direction": [0, 1, 0]}, "mm_per_pixel": 2},
            {"axis": {"point": [50, 50, -60], "direction": [0, 1, 0]}, "mm_per_pixel": 2, "at": 2},
        ],
        "match_attachments": [{"pattern": "{name}.png", "column": "name", "names": ["Find 1.png"]}],
    }


def accepted_types(server, path, operation):
    """Yields JSON, CSV if the contract offers it, any type for GIS programs, and the types of linked
    data."""
    yield "application/json"
    if path.startswith("/ogc"):
        yield "*/*"
    if path.startswith("/id"):
        yield from ("text/turtle", "text/html")
    offered = (
        server.contract._resolve(response).get("content", {})
        for status, response in operation["responses"].items()
        if status == "200"
    )
    if any("text/csv" in types for types in offered):
        yield "text/csv"


def sweep(server, token, words_of, camera):
    """Sends every query of the contract about public content. Returns the number of responses, and
    the queries whose response contained a secret."""
    bodies, answered, told = reading_bodies(camera), 0, {}
    for path, operations in server.contract.document["paths"].items():
        # these responses have no end; events_test.py reads them
        if not path.startswith(("/api/v1", "/id", "/ogc")) or path.endswith(("/live", "/events")):
            continue
        for method, operation in operations.items():
            asked = (
                bodies.get(operation["operationId"])
                if method == "post" and isinstance(operation, dict)
                else [None]
                if method == "get"
                else None
            )
            for filled in fillings(address_of(path), words_of) if asked else []:
                for parameters in queries(server, path, operation):
                    for body in asked:
                        for accept in accepted_types(server, path, operation):
                            answer = server.request(
                                method.upper(),
                                query(filled, **parameters),
                                body,
                                token=token,
                                headers={"Accept": accept},
                            )
                            answered += answer.status == 200
                            if leaks(answer.body):
                                told.setdefault(
                                    operation["operationId"],
                                    (filled, parameters, leaks(answer.body)),
                                )
    return answered, told


def same_answer(server, token, method, path, body, secret, ghost, headers=None):
    """Checks that objects that the user cannot see get the same response as missing ones."""

    def swapped(thing):
        return (
            type(thing)(re.sub(re.escape(secret), ghost, thing))
            if isinstance(thing, str)
            else [swapped(item) for item in thing]
            if isinstance(thing, list)
            else {swapped(k): swapped(v) for k, v in thing.items()}
            if isinstance(thing, dict)
            else thing
        )

    there = server.request(method, path, body, token=token, headers=headers)
    nowhere = server.request(method, swapped(path), swapped(body), token=token, headers=headers)
    plain = there.body.decode().replace(urllib.parse.quote(secret), ghost).replace(secret, ghost)
    assert there.status == nowhere.status >= 400 and plain == nowhere.body.decode(), (
        method,
        path,
        body,
        there,
        nowhere,
    )
    return there.status


def doors_closed(server, token, words_of, hidden, thread):
    """Returns every address of a secret, and the addresses that also contain one."""
    count = 0
    for path, operations in server.contract.document["paths"].items():
        for name, before, secret, ghost in (
            ("layer", "", LAYER, GHOSTS[LAYER]),
            ("layer", "", KEYS, GHOSTS[KEYS]),
            ("column", "", COLUMN, GHOSTS[COLUMN]),
            ("collection", "sheet.", LAYER, GHOSTS[LAYER]),
            ("collection", "sheet.", KEYS, GHOSTS[KEYS]),
            ("collection", "sheet.finds.", COLUMN, GHOSTS[COLUMN]),
            ("attachment", "", str(hidden["id"]), "987654"),
            ("comment", "", str(thread), "987654"),
        ):
            if "{" + name + "}" not in path:
                continue
            for filled in fillings(address_of(path), {**words_of, name: [before + secret]}):
                for method in operations:
                    if method not in ("get", "post", "put", "patch", "delete"):
                        continue
                    body = {} if method in JSON_CHANGES else None
                    if secret.isdigit():  # the id as a whole word
                        answers = [
                            server.request(
                                method.upper(),
                                filled.replace(f"/{secret}", f"/{ref}"),
                                body,
                                token=token,
                            )
                            for ref in (secret, ghost)
                        ]
                        assert answers[0].status == answers[1].status >= 400, (
                            method,
                            filled,
                            answers,
                        )
                        assert (
                            answers[0].body.decode().replace(f"`{secret}`", f"`{ghost}`")
                            == answers[1].body.decode()
                        ), (method, filled, answers)
                    else:
                        same_answer(server, token, method.upper(), filled, body, secret, ghost)
                    count += 1
    return count


def names_unknown(server, token, camera):
    """Uses the names of secrets in expressions, filters and lists."""
    asked = [
        (
            "GET",
            query(
                "//ogc/collections/sheet/position",
                coords="POINT(0.05 0.05)",
                **{"parameter-name": LAYER},
            ),
            None,
        ),
        (
            "GET",
            query(M + "/position", coords="POINT Z(50 50 0)", **{"parameter-name": LAYER}),
            None,
        ),
        ("POST", M + "/positions", {"points": [[50, 50, 0]], "layers": [LAYER]}),
        (
            "POST",
            M + "/profile",
            {"places": [[5, 5, 0], [95, 95, 0]], "step_mm": 5, "layers": [LAYER]},
        ),
        ("POST", M + "/select", {"where": f'"{LAYER}" > 0'}),
        ("POST", M + "/select", {"where": "cracks > 0", "layers": [LAYER]}),
        ("POST", M + "/select", {"changed": {"from": 0, "layers": [LAYER]}}),
        ("POST", M + "/select", {"where": f"finds.\"{COLUMN}\" = 'x'"}),
        ("GET", query(M + "/layers/cracks/statistics", where=f'valid("{LAYER}")'), None),
        ("GET", query(M + "/layers/finds/texels.csv", columns=COLUMN), None),
        ("GET", query(M + "/layers/finds/texels.csv", where=f'"{LAYER}" > 0'), None),
        ("POST", M + "/cross-table", {"rows": KEYS, "columns": "cracks"}),
        ("POST", M + "/cross-table", {"rows": "cracks", "columns": KEYS}),
        ("POST", M + "/frame", {"camera": camera, "layers": [LAYER]}),
        (
            "POST",
            M + "/frame",
            {"camera": camera, "highlights": [{"layer": KEYS, "highlight": {"keys": [2]}}]},
        ),
        (
            "POST",
            M + "/frame",
            {
                "camera": camera,
                "highlights": [
                    {"layer": "finds", "highlight": {"filter": f'"{COLUMN}" is not null'}}
                ],
            },
        ),
        ("POST", M + "/layers/finds/extent", {"filter": f'"{COLUMN}" is not null'}),
        ("GET", query("/tables/finds/records", filter=f'"{COLUMN}" is not null'), None),
        ("GET", query("/tables/finds/records", sortby=COLUMN), None),
        ("GET", query(M + "/layers/finds/records", filter=f'"{COLUMN}" is not null'), None),
        (
            "POST",
            "/tables/finds/attachments/match",
            {"pattern": "{" + COLUMN + "}.png", "column": COLUMN, "names": ["a.png"]},
        ),
        (
            "POST",
            M + "/layers/cracks/edits",
            {"op": "fill", "mode": "where", "where": f'"{LAYER}" > 0', "value": 1},
        ),
        ("POST", "/tables/finds/records", {"values": {COLUMN: "x"}}),
        ("PATCH", "/tables/finds/records/2", {"values": {COLUMN: "x"}}),
        ("POST", query("/tables/finds/records/2/attachments", column=COLUMN), PNG),
    ]
    for method, path, body in asked:
        secret = next(
            each for each in (LAYER, KEYS, COLUMN) if each in urllib.parse.unquote(path) + str(body)
        )
        same_answer(server, token, method, path, body, secret, GHOSTS[secret])
    return len(asked)
