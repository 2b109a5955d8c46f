#!/usr/bin/env python3
"""Who sees what: private layers, columns and attachments are not there for viewers and annotators, through every door of the contract."""
import hashlib
import io
import os
import re
import struct
import sys
import urllib.parse
import zipfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from support.cameras import camera_from
from support.live_client import LAST_RECTANGLE, LiveClient
from support.meshes import folded_grid
from support.pictures import png
from support.sql_reader import Reader, free_port
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"  # nearly flat, x and y from 0 to 100 mm
VALUE = 48611.5  # painted on the secret layer
LAYER, KEYS, COLUMN, CELL, FILE, CRACK = "tomb-q7x", "bones-q5v", "hoard-q8y", "gold-q9z", "relic-q6w.png", "secret-q3u"
MARKS = [mark.encode() for mark in (LAYER, "tomb q7x", KEYS, "bones q5v", COLUMN, "hoard q8y", CELL, FILE, CRACK, "secret q3u", str(VALUE))] + [struct.pack("<f", VALUE)]
GHOSTS = {LAYER: "tomb-zzz", KEYS: "bones-zzz", COLUMN: "hoard-zzz"}  # as long, since messages count characters
PNG = png(8, 8, lambda x, y: (200, 100, 50))
JSON_CHANGES = ("post", "put", "patch")


def query(path, **parameters):
    return path + "?" + urllib.parse.urlencode(parameters)


def leaks(body):
    """The marks of secrets in an answer; workbooks are looked into."""
    if body.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(body)) as book:
            body = b"".join(book.read(name) for name in book.namelist())
    plain = body.lower()
    return [mark for mark in MARKS if mark.lower() in plain]


def make_site(server):
    model = server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048)
    camera = camera_from(model, (0, 0, 1), up=(0, 1, 0))
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    columns = [{"name": "Name"}, {"name": "Depth", "kind": "numeric"}, {"name": "Photo", "kind": "picture"}, {"name": "Edge", "kind": "line"}]
    server.ok("POST", M + "/layers", {"name": "Finds", "kind": "database", "type": "u16", "columns": columns})
    server.ok("POST", "/tables/finds/records", {"records": [{"values": {"name": f"Find {n}", "depth": n}} for n in (1, 2)]})
    public = server.ok("POST", query("/tables/finds/records/1/attachments", name="plan.png"), PNG).json()["attachments"][0]
    for layer, value in (("cracks", 3), ("finds", 1)):
        server.ok("POST", f"{M}/layers/{layer}/edits", {"op": "fill", "mode": "where", "where": "x < 5", "value": value})  # little, since every texel is told again and again
    before = server.ok("POST", M + "/frame", {"camera": camera, "format": "png"}).body
    # Secrets, from their first moment.
    secret = {"visibility": "private"}
    server.ok("POST", M + "/layers", {"name": "Tomb q7x", "type": "f32", **secret})
    server.ok("POST", f"{M}/layers/{LAYER}/edits", {"op": "fill", "mode": "where", "where": "true", "value": VALUE})
    server.ok("POST", M + "/layers", {"name": "Bones q5v", "kind": "database", "type": "u16", "table": "finds", **secret})
    server.ok("POST", f"{M}/layers/{KEYS}/edits", {"op": "fill", "mode": "where", "where": f'"{LAYER}" > 0', "value": 2})
    server.ok("POST", "/tables/finds/columns", {"name": "Hoard q8y", **secret})
    server.ok("POST", "/tables/finds/columns", {"name": "Secret q3u", "kind": "line", **secret})
    line = [{"model": model["id"], "coordinates": [[10, 10, 0], [90, 90, 0]]}]
    server.ok("PATCH", "/tables/finds/records/1", {"values": {COLUMN: CELL, CRACK: line}})
    hidden = server.ok("POST", query("/tables/finds/records/1/attachments", name=FILE, column="photo", visibility="private"), PNG).json()["attachments"][0]
    thread = server.ok("POST", M + "/comments", {"text": f"{CELL} lies here", "position": [50, 50, 0], "layer": LAYER}).json()["id"]
    server.ok("POST", f"/comments/{thread}/replies", {"text": f"Much {CELL}?"})
    column_shown = {"layer": "finds", "highlight": {"filter": f"\"{COLUMN}\" = '{CELL}'"}}
    server.ok("POST", M + "/views", {"name": "Plan", "camera": camera, "layers": [{"layer": LAYER, "opacity": 0.5}, column_shown]})
    stop = {"view": "plan", "title": {"en": "Here"}, "layers": [LAYER], "records": [{"table": "finds", "keys": [1], "columns": [{"column": COLUMN}, {"column": "name"}]}]}
    server.ok("POST", M + "/tours", {"name": "Round", "languages": ["en"], "stops": [stop]})
    server.ok("POST", M + "/tours/round/kiosks", {"name": "Hall"})
    assert hidden["visibility"] == "private" and public["visibility"] == "public"
    return camera, before, public, hidden, thread


def words(server, public):
    """What the parameters of paths stand for, public things alone."""
    job = server.get("/jobs").json()["jobs"][0]["id"]
    look = server.get(M + "/looks").json()["looks"]
    return {"project": ["default"], "model": ["sheet"], "layer": ["cracks", "finds"], "table": ["finds"], "key": ["1"], "column": ["name", "depth", "photo"], "attachment": [str(public["id"])],
            "job": [str(job)], "look": [each["slug"] for each in look] or ["1"], "comment": ["1"], "view": ["plan"], "tour": ["round"], "kiosk": ["1"], "name": ["sheet.ply"], "format": ["npy", "png", "tif"], "tool": ["1"], "template": ["1"],
            "user": ["owner"], "session": ["1"], "token": ["1"]}


def fillings(path, words_of):
    """The path with each of the words in place of its parameters."""
    parameter = re.search(r"\{(\w+)\}", path)
    if not parameter:
        return [path]
    return [filled for word in words_of[parameter[1]] for filled in fillings(path.replace(parameter[0], word, 1), words_of)]


def queries(server, path, operation):
    """No query, then each parameter with each value that the contract tells of it."""
    parameters = [server.contract._resolve(each) for each in operation.get("parameters", []) + server.contract.document["paths"][path].get("parameters", [])]
    parameters = [each for each in parameters if each["in"] == "query"]
    given = {"coords": ["POINT Z(50 50 0)"], "filter": ["depth > 0"], "sortby": ["name", "-depth"], "at": ["1", "2"], "where": ["cracks > 0"], "include": ["pieces,perimeter,quantiles"], "cell": ["0.02"],
             "columns": ["name,depth"], "key": ["1"], "layers": ["cracks"], "parameter-name": ["cracks,finds"], "project": ["default"]}
    values = {each["name"]: given.get(each["name"]) or [str(value) for value in server.contract._resolve(each["schema"]).get("enum", [])] for each in parameters}
    base = {each["name"]: values[each["name"]][0] for each in parameters if each.get("required") and values[each["name"]]}
    yield base
    for name, choices in values.items():
        for choice in choices:
            yield {**base, name: choice}


def reading_bodies(camera):
    """Questions that have a body."""
    line = {"places": [[5, 5, 0], [95, 95, 0]], "step_mm": 5}
    return {"positions": [{"points": [[50, 50, 0]]}], "pick": [{"camera": camera, "x": 300, "y": 200}], "profile": [line], "select": [{"where": "cracks > 0", "layers": ["cracks", "finds"]}],
            "cross_table": [{"rows": "finds", "columns": "cracks"}], "frame": [{"camera": camera, "format": "png"}, {"camera": camera, "format": "png", "at": 2}],
            "record_extent": [{"filter": "depth > 0"}], "make_figure": [{"format": "svg", "dpi": 50}, {"format": "svg", "dpi": 50, "view": "plan"}, {"format": "svg", "dpi": 50, "labels": {"layer": "finds", "column": "name"}}],
            "match_attachments": [{"pattern": "{name}.png", "column": "name", "names": ["Find 1.png"]}]}


def sweep(server, token, words_of, camera):
    """Every question of the contract about what is public: how many were answered, and which told a secret."""
    bodies, answered, told = reading_bodies(camera), 0, {}
    for path, operations in server.contract.document["paths"].items():
        if not path.startswith("/api/v1") or path.endswith(("/live", "/events")):  # without an end; events_test.py listens
            continue
        for method, operation in operations.items():
            asked = bodies.get(operation["operationId"]) if method == "post" and isinstance(operation, dict) else [None] if method == "get" else None
            for filled in fillings(path.removeprefix("/api/v1"), words_of) if asked else []:
                for parameters in queries(server, path, operation):
                    for body in asked:
                        for accept in ("application/json", "text/csv"):
                            answer = server.request(method.upper(), query(filled, **parameters), body, token=token, headers={"Accept": accept})
                            answered += answer.status == 200
                            if leaks(answer.body):
                                told.setdefault(operation["operationId"], (filled, parameters, leaks(answer.body)))
    return answered, told


def same_answer(server, token, method, path, body, secret, ghost, headers=None):
    """What is there and not for them answers like what is not there."""
    def swapped(thing):
        return type(thing)(re.sub(re.escape(secret), ghost, thing)) if isinstance(thing, str) else \
            [swapped(item) for item in thing] if isinstance(thing, list) else {swapped(k): swapped(v) for k, v in thing.items()} if isinstance(thing, dict) else thing

    there = server.request(method, path, body, token=token, headers=headers)
    nowhere = server.request(method, swapped(path), swapped(body), token=token, headers=headers)
    plain = there.body.decode().replace(urllib.parse.quote(secret), ghost).replace(secret, ghost)
    assert there.status == nowhere.status >= 400 and plain == nowhere.body.decode(), (method, path, body, there, nowhere)
    return there.status


def doors_closed(server, token, words_of, hidden, thread):
    """Every address that leads to a secret, and those that name one beside it."""
    count = 0
    for path, operations in server.contract.document["paths"].items():
        for name, secret, ghost in (("layer", LAYER, GHOSTS[LAYER]), ("layer", KEYS, GHOSTS[KEYS]), ("column", COLUMN, GHOSTS[COLUMN]), ("attachment", str(hidden["id"]), "987654"), ("comment", str(thread), "987654")):
            if "{" + name + "}" not in path:
                continue
            for filled in fillings(path.removeprefix("/api/v1"), {**words_of, name: [secret]}):
                for method in operations:
                    if method not in ("get", "post", "put", "patch", "delete"):
                        continue
                    body = {} if method in JSON_CHANGES else None
                    if secret.isdigit():  # the id as a whole
                        answers = [server.request(method.upper(), filled.replace(f"/{secret}", f"/{ref}"), body, token=token) for ref in (secret, ghost)]
                        assert answers[0].status == answers[1].status >= 400, (method, filled, answers)
                        assert answers[0].body.decode().replace(f"`{secret}`", f"`{ghost}`") == answers[1].body.decode(), (method, filled, answers)
                    else:
                        same_answer(server, token, method.upper(), filled, body, secret, ghost)
                    count += 1
    return count


def names_unknown(server, token, camera):
    """Names of secrets in expressions, filters and lists."""
    asked = [("GET", query(M + "/position", coords="POINT Z(50 50 0)", **{"parameter-name": LAYER}), None),
             ("POST", M + "/positions", {"points": [[50, 50, 0]], "layers": [LAYER]}),
             ("POST", M + "/profile", {"places": [[5, 5, 0], [95, 95, 0]], "step_mm": 5, "layers": [LAYER]}),
             ("POST", M + "/select", {"where": f'"{LAYER}" > 0'}), ("POST", M + "/select", {"where": "cracks > 0", "layers": [LAYER]}),
             ("POST", M + "/select", {"where": f'finds."{COLUMN}" = \'x\''}),
             ("GET", query(M + "/layers/cracks/statistics", where=f'valid("{LAYER}")'), None),
             ("GET", query(M + "/layers/finds/texels.csv", columns=COLUMN), None), ("GET", query(M + "/layers/finds/texels.csv", where=f'"{LAYER}" > 0'), None),
             ("POST", M + "/cross-table", {"rows": KEYS, "columns": "cracks"}), ("POST", M + "/cross-table", {"rows": "cracks", "columns": KEYS}),
             ("POST", M + "/frame", {"camera": camera, "layers": [LAYER]}),
             ("POST", M + "/frame", {"camera": camera, "highlights": [{"layer": KEYS, "highlight": {"keys": [2]}}]}),
             ("POST", M + "/frame", {"camera": camera, "highlights": [{"layer": "finds", "highlight": {"filter": f'"{COLUMN}" is not null'}}]}),
             ("POST", M + "/layers/finds/extent", {"filter": f'"{COLUMN}" is not null'}),
             ("GET", query("/tables/finds/records", filter=f'"{COLUMN}" is not null'), None), ("GET", query("/tables/finds/records", sortby=COLUMN), None),
             ("GET", query(M + "/layers/finds/records", filter=f'"{COLUMN}" is not null'), None),
             ("POST", "/tables/finds/attachments/match", {"pattern": "{" + COLUMN + "}.png", "column": COLUMN, "names": ["a.png"]}),
             ("POST", M + "/layers/cracks/edits", {"op": "fill", "mode": "where", "where": f'"{LAYER}" > 0', "value": 1}),
             ("POST", "/tables/finds/records", {"values": {COLUMN: "x"}}), ("PATCH", "/tables/finds/records/2", {"values": {COLUMN: "x"}}),
             ("POST", query("/tables/finds/records/2/attachments", column=COLUMN), PNG)]
    for method, path, body in asked:
        secret = next(each for each in (LAYER, KEYS, COLUMN) if each in urllib.parse.unquote(path) + str(body))
        same_answer(server, token, method, path, body, secret, GHOSTS[secret])
    return len(asked)


def shows_through(server):
    """What more people see is not made of what fewer see, however it is tried."""
    def refused(status, method, path, body, field):
        answer = server.request(method, path, body)
        assert answer.status == status and answer.json()["field"] == field and "show through" in answer.json()["title"], answer

    refused(422, "POST", M + "/layers", {"name": "Sum", "expression": f'"{LAYER}" + 1'}, "expression")
    refused(422, "POST", M + "/layers", {"name": "Sum", "expression": f'if(finds."{COLUMN}" = \'x\', 1, 0)'}, "expression")
    refused(422, "POST", f"{M}/layers/cracks/edits", {"op": "fill", "mode": "where", "where": f'"{LAYER}" > 0', "value": 1}, "where")
    by_column = {"mode": "categorical", "points": [], "column": COLUMN}
    refused(422, "PATCH", M + "/layers/finds", {"palette": by_column}, "palette.column")
    server.ok("PATCH", f"{M}/layers/{KEYS}", {"palette": by_column})
    refused(422, "PATCH", f"{M}/layers/{KEYS}", {"visibility": "team"}, "palette.column")
    server.ok("POST", M + "/layers", {"name": "Sum", "expression": f'"{LAYER}" + finds.depth', "visibility": "private"})
    refused(422, "PATCH", M + "/layers/sum", {"visibility": "team"}, "expression")
    server.ok("PATCH", M + "/layers/sum", {"expression": "cracks + finds.depth"})
    server.ok("POST", M + "/layers/sum/compute")
    server.ok("PATCH", M + "/layers/sum", {"visibility": "public"})
    refused(409, "PATCH", M + "/layers/cracks", {"visibility": "private"}, "visibility")
    refused(409, "PATCH", "/tables/finds/columns/depth", {"visibility": "team"}, "visibility")
    server.ok("PATCH", M + "/layers/finds", {"palette": {**by_column, "column": "name"}})
    refused(409, "PATCH", "/tables/finds/columns/name", {"visibility": "private"}, "visibility")
    server.ok("DELETE", M + "/layers/sum")
    for body in ({"visibility": "private", "name": "Both"}, {"visibility": "secret"}, {"visibility": None}):
        assert server.request("PATCH", "/tables/finds/columns/depth", body).status == 422, body
    assert server.post("/tables/finds/columns", {"name": "Must", "required": True, "visibility": "private"}).status == 422
    for path in (M + "/layers/cracks", "/models/sheet"):
        assert server.request("PATCH", path, {"visibility": "hidden"}).status == 422


def ladder(server, viewer, annotator, curator, public):
    """What each role sees of each kind of thing, as it changes; what was seen in the past is hidden, too."""
    def seen(path):
        return tuple(server.get(path, token=token).status == 200 for token in (viewer, annotator, curator))

    by_visibility = {"public": (True, True, True), "team": (False, True, True), "private": (False, False, True)}
    layer, column, file = M + "/layers/cracks", "/tables/finds/columns/depth", f"/attachments/{public['id']}"
    for visibility in ("team", "private", "public"):
        for path in (layer, column, file):
            assert server.request("PATCH", path, {"visibility": visibility}, token=viewer).status in (403, 404)
            assert server.request("PATCH", path, {"visibility": visibility}, token=annotator).status in (403, 404), path
            server.ok("PATCH", path, {"visibility": visibility}, token=curator)
        expected = by_visibility[visibility]
        assert seen(layer) == seen(layer + "/edits") == seen(layer + "/texels.npy") == seen(file) == seen(file + "?thumbnail=64") == expected, visibility
        assert seen(column + "/classes") == seen(query("/tables/finds/records", sortby="depth")) == expected, visibility
        for token, sees in zip((viewer, annotator, curator), expected):
            assert ("depth" in server.get("/tables/finds/records/1?at=1", token=token).json()["values"]) == sees, visibility
            assert ("plan.png" in str(server.get("/tables/finds/records/1/attachments", token=token).json())) == sees, visibility
    # Who attaches a file sees it, and says who does.
    mine = server.ok("POST", query("/tables/finds/records/2/attachments", name="mine.png", visibility="private"), PNG, token=annotator).json()["attachments"][0]
    path = f"/attachments/{mine['id']}"
    assert seen(path) == (False, True, True)
    other = server.add_person("other", "annotator")
    assert server.get(path, token=other).status == server.request("PATCH", path, {"visibility": "public"}, token=other).status == server.request("DELETE", path, token=other).status == 404
    server.ok("PATCH", path, {"visibility": "team"}, token=annotator)
    assert server.get(path, token=other).status == 200 and seen(path) == (False, True, True)
    # A cell that is written by who does not see one of its files keeps it.
    cell = server.get("/tables/finds/records/1", token=viewer).json()["values"]["photo"]
    assert len(cell) == 2, "ids of files stay in their cells, and tell nothing"


def undo_shows_nothing(server, viewer, annotator):
    """The journal of a table tells nothing of a column that is hidden, and no undo shows it."""
    for token in (viewer, annotator):
        answer = server.get("/tables/finds/edits", token=token)
        assert not leaks(answer.body), answer
    assert leaks(server.get("/tables/finds/edits").body)
    server.ok("POST", "/tables/finds/undo")
    server.ok("POST", "/tables/finds/redo")
    columns = server.get("/tables/finds/columns", token=viewer).json()["columns"]
    assert COLUMN not in [column["slug"] for column in columns], columns


def still(connection):
    """A whole picture at rest, as it came."""
    parts = []
    while True:
        frame = connection.receive_until("frame")
        parts.append(frame["payload"])
        if frame["flags"] & LAST_RECTANGLE:
            if frame["flags"] & 2:
                return hashlib.sha256(b"".join(parts)).hexdigest()
            parts = []


def live(server, viewer, annotator, camera, thread):
    """An open connection sees what it may from one moment to the next."""
    def message(connection, *ops):
        told = connection.receive_until(*ops)
        assert not leaks(repr({key: value for key, value in told.items() if key != "payload"}).encode()), told
        return told

    with LiveClient(server, "sheet", token=viewer) as eyes, LiveClient(server, "sheet", token=annotator) as hand:
        for connection in (eyes, hand):
            welcome = connection.hello(dpr=1, accept=["jpeg"])
            assert not leaks(repr(welcome).encode()) and {layer["slug"] for layer in welcome["layers"]} == {"cracks", "finds"}, welcome
            connection.send({"op": "camera", "seq": 1, "moving": False, **camera})
        before = still(eyes)
        # Edits of the secret layer are not told, and its records' cells neither.
        server.ok("POST", f"{M}/layers/{LAYER}/edits", {"op": "fill", "mode": "where", "where": "x < 30", "value": VALUE})
        server.ok("PATCH", "/tables/finds/records/1", {"values": {COLUMN: CELL + " twice"}})
        for connection in (eyes, hand):
            told = message(connection, "record", "layer")
            assert told["op"] == "record" and told["key"] == 1 and COLUMN not in told["record"]["values"], told
            connection.send({"op": "layers", "layers": [{"layer": LAYER, "visible": True}]})
            assert connection.receive_until("problem")["status"] == 404
            connection.send({"op": "pick", "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b11", "camera": camera, "x": 320, "y": 240})
            message(connection, "picked")
        # It becomes seen, and is gone again.
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "team"})
        shown = hand.receive_until("layer")
        assert shown["event"] == "created" and shown["layer"]["slug"] == LAYER, shown
        assert hand.receive_until("comment")["event"] == "changed", "the thread about the layer is seen with it"
        hand.send({"op": "stroke.begin", "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b01", "stroke": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b02", "layer": LAYER, "value": 1, "camera": camera, "radius_px": 8})
        hand.send({"op": "stroke.extend", "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b03", "stroke": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b02", "n": 0, "path": [[300, 200], [310, 200]]})
        hand.receive_until("saved")
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "private"})
        gone = hand.receive_until("layer")
        while gone["event"] == "edited":
            gone = hand.receive_until("layer")
        assert gone["event"] == "deleted" and "layer" not in gone, gone
        told = hand.receive_until("comment")
        assert told["event"] == "deleted" and told["comment_id"] == thread and "comment" not in told, told
        hand.send({"op": "stroke.extend", "id": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b04", "stroke": "6f2d1c9e-5a5b-4c55-9d55-0a7f0c8a2b02", "n": 1, "path": [[320, 200]]})
        assert hand.receive_until("problem", "saved")["status"] == 404, "a stroke goes on over a layer that is not seen any more"
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "public"})
        shown = message_of_layer(eyes)
        assert shown["event"] == "created" and shown["layer"]["slug"] == LAYER, shown
        wait_for(lambda: still(eyes) != before, "the picture to show the layer")
        server.ok("PATCH", f"{M}/layers/{LAYER}", {"visibility": "private"})
        assert message_of_layer(eyes)["event"] == "deleted"
        wait_for(lambda: still(eyes) == before, "the picture to be as if there was no such layer")


def message_of_layer(connection):
    return connection.receive_until("layer")


def source(server, viewer, annotator, curator):
    """The scan's files, its mesh and its pictures in full are a right of their own."""
    doors = [M + "/source/sheet.ply", M + "/vertices.ply"]
    look = server.ok("POST", query(M + "/looks", name="UV"), PNG).json()["slug"]
    doors.append(f"{M}/looks/{look}/picture")
    for least, expected in (("annotator", (403, 200, 200)), ("curator", (403, 403, 200)), ("viewer", (200, 200, 200)), ("annotator", (403, 200, 200))):
        assert server.ok("PATCH", M, {"source_download": least}).json()["source_download"] == least
        for door in doors:
            assert tuple(server.get(door, token=token).status for token in (viewer, annotator, curator)) == expected, (least, door)
        assert server.get(f"{M}/looks/{look}/picture?thumbnail=96", token=viewer).status == 200
    assert server.request("PATCH", M, {"source_download": "viewer"}, token=annotator).status == 403
    assert server.request("PATCH", M, {"source_download": "owner"}).status == 422


def sql(server, reader):
    """Analysts see what everybody sees."""
    assert {row["slug"] for row in reader.rows("SELECT slug FROM layers")} == {"cracks", "finds"}
    for view in ("layers", "areas", "edits", "record_edits", '"Finds"'):
        done = reader.run(f"SELECT * FROM {view}")
        assert done.returncode == 0 and not leaks(done.stdout.encode()), (view, done)
    server.ok("PATCH", f"/tables/finds/columns/{COLUMN}", {"visibility": "team"})
    assert not leaks(reader.run('SELECT * FROM "Finds"').stdout.encode())
    server.ok("PATCH", f"/tables/finds/columns/{COLUMN}", {"visibility": "public"})
    assert leaks(reader.run('SELECT * FROM "Finds"').stdout.encode())
    server.ok("PATCH", f"/tables/finds/columns/{COLUMN}", {"visibility": "private"})
    assert not leaks(reader.run('SELECT * FROM "Finds"').stdout.encode())


def main():
    port = free_port()
    with StrataServer(options=["--sql-listen", f"127.0.0.1:{port}"]) as server:
        camera, before, public, hidden, thread = make_site(server)
        viewer, annotator, curator = (server.add_person(role, role) for role in ("viewer", "annotator", "curator"))
        words_of = words(server, public)
        answered, told = sweep(server, curator, words_of, camera)
        assert answered > 200 and len(told) > 15, (answered, sorted(told))
        print(f"curators: {answered} answers, secrets in {len(told)} operations", flush=True)
        for token, role in ((viewer, "viewer"), (annotator, "annotator")):
            picture = server.ok("POST", M + "/frame", {"camera": camera, "format": "png"}, token=token).body
            assert picture == before, f"the picture of a {role} is another than without the secrets"
            answered, told = sweep(server, token, words_of, camera)
            assert answered > 150 and not told, (role, answered, told)
            named = names_unknown(server, token, camera)
            closed = doors_closed(server, token, words_of, hidden, thread)
            assert closed > 60, closed
            print(f"{role}: {answered} answers without a secret, {closed} doors closed, {named} names unknown", flush=True)
        assert server.ok("POST", M + "/frame", {"camera": camera, "format": "png"}, token=curator).body != before
        undo_shows_nothing(server, viewer, annotator)
        live(server, viewer, annotator, camera, thread)
        sql(server, Reader(server, port))
        source(server, viewer, annotator, curator)
        ladder(server, viewer, annotator, curator, public)
        shows_through(server)
        server.ok("DELETE", f"{M}/layers/{LAYER}")
        for token, seen in ((viewer, False), (annotator, False), (curator, True)):
            assert (str(thread) in [str(each["id"]) for each in server.get(M + "/comments", token=token).json()["comments"]]) == seen, "a thread outlives its layer"
        assert server.stop() == 0
        server.assert_clean_log()


if __name__ == "__main__":
    main()
