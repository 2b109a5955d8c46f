"""A site with a tour, and the link of a kiosk that shows the tour. Attempts to use that link for
anything else, with every operation of the contract."""
import re

from support.addresses import query
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png

M = "/models/sheet"
ALL = M + "/tours"
PNG = png(8, 8, lambda x, y: (200, 100, 50))
COLUMN, CELL, LAYER = "hoard-q8y", "gold-q9z", "tomb-q7x"  # hidden texts


def told(answer, status, field=None):
    assert answer.status == status, (status, answer)
    problem = answer.json()
    assert problem["detail"] and (field is None or problem.get("field") == field), (field, problem)
    return problem


def make_site(server):
    model = server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.import_model(
        folded_grid(fold=0.002), "other.ply", name="Other", unit="mm", resolution=2048
    )
    server.ok("POST", "/projects", {"name": "Villa"})
    server.import_model(
        folded_grid(fold=0.003),
        "villa.ply",
        name="Villa wall",
        unit="mm",
        resolution=2048,
        project="villa",
    )
    camera = camera_from(model, (0, 0, 1), up=(0, 1, 0))
    server.ok(
        "POST",
        query("/projects/default/terms", name="Damage"),
        b"code,label\nloss,Loss\n",
        headers={"Content-Type": "text/csv"},
    )
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    columns = [
        {"name": "Name"},
        {"name": "Photo", "kind": "picture"},
        {"name": "What", "kind": "term", "target": "damage"},
    ]
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Finds", "kind": "database", "type": "u16", "columns": columns},
    )
    server.ok(
        "POST",
        "/tables/finds/records",
        {"records": [{"values": {"name": f"Find {n}", "what": 1}} for n in (1, 2)]},
    )
    server.ok("POST", "/tables/finds/columns", {"name": "Hoard q8y", "visibility": "private"})
    server.ok("PATCH", "/tables/finds/records/1", {"values": {COLUMN: CELL}})
    server.ok("POST", M + "/layers", {"name": "Tomb q7x", "type": "f32", "visibility": "private"})
    for name in ("Ledger", "Archive"):  # tables without a layer
        server.ok(
            "POST", "/projects/default/tables", {"name": name, "columns": [{"name": "Price"}]}
        )
        server.ok("POST", f"/tables/{name.lower()}/records", {"values": {"price": "7"}})
    server.ok(
        "POST", "/projects/villa/tables", {"name": "Elsewhere", "columns": [{"name": "Price"}]}
    )
    files = {}
    for of, column, visibility in (("finds", "photo", "public"), ("finds", "photo", "private")):
        files[visibility] = server.ok(
            "POST",
            query(
                f"/tables/{of}/records/1/attachments",
                name=f"{visibility}.png",
                column=column,
                visibility=visibility,
            ),
            PNG,
        ).json()["attachments"][0]["id"]
    server.ok("POST", "/tables/ledger/columns", {"name": "Scan", "kind": "picture"})
    files["elsewhere"] = server.ok(
        "POST", query("/tables/ledger/records/1/attachments", name="x.png"), PNG
    ).json()["attachments"][0]["id"]
    thread = server.ok("POST", M + "/comments", {"text": "Look.", "position": [50, 50, 0]}).json()[
        "id"
    ]
    for name in ("West", "East"):
        server.ok(
            "POST",
            M + "/views",
            {
                "name": name,
                "camera": camera,
                "layers": [{"layer": "cracks", "opacity": 0.5}, {"layer": LAYER, "opacity": 0.5}],
            },
        )
    server.ok("POST", "/models/other/views", {"name": "Other view", "camera": camera})
    return camera, files, thread


STOP = {
    "view": "west",
    "title": {"en": "The west", "es": "El oeste"},
    "text": {"en": "Broken\nin 2019."},
    "attract_s": 12.5,
    "transition": "cut",
    "transition_s": 0,
    "layers": ["cracks", LAYER],
    "records": [
        {
            "table": "finds",
            "keys": [2, 1],
            "columns": [
                {"column": COLUMN, "labels": {"en": "Hoard"}},
                {"column": "name", "labels": {"es": "Nombre"}},
            ],
        },
        {"table": "archive", "keys": [], "columns": [{"column": "price"}]},
    ],
}
TOUR = {
    "name": "Once around",
    "text": "For all.",
    "languages": ["en", "es"],
    "idle_s": 90,
    "stops": [STOP, {"view": "east", "title": {"en": "The east"}}],
}


def make_kiosk(server, tour, name="Hall", **more):
    made = server.ok("POST", tour + "/kiosks", {"name": name, **more}).json()
    start, _, secret = made["path"].rpartition("/")
    assert start == "/kiosk" and len(secret) == 43, made
    return made["kiosk"], secret


def is_open(path):
    """Returns whether the contract lets a kiosk read this path of the model."""
    return re.fullmatch(
        r"/api/v1/(kiosk|models/\{model\}(|/layers(|/\{layer\}(|/records/\{key\}(|/attachments)))|/looks(|/\{look\})|/views(|/\{view\}(|/picture))|/tours/\{tour\}(|/files/\{file\}))"
        r"|tables/\{table\}(|/columns|/terms|/records/\{key\}(|/attachments))|attachments/\{attachment\})",
        path,
    )


def sweep(server, secret, tour, files, thread):
    """Sends every request of the contract. Changes are refused, and reads return only content of
    the one model. Returns the numbers of allowed and of refused operations."""
    shown = server.ok("POST", query(tour + "/files", name="west.png"), PNG).json()["id"]
    words = {
        "model": "sheet",
        "layer": "finds",
        "look": "1",
        "view": "west",
        "tour": tour.rsplit("/", 1)[1],
        "snapshot": "1",
        "selection": "1",
        "photograph": "1",
        "collection": "sheet.finds",
        "feature": "1",
        "annotation": "areas.1",
        "plane": "xy",
        "table": "finds",
        "key": "1",
        "attachment": str(files["public"]),
        "file": str(shown),
        "column": "name",
        "project": "default",
        "comment": str(thread),
        "job": "1",
        "user": "owner",
        "session": "1",
        "token": "1",
        "tool": "1",
        "template": "1",
        "name": "sheet.ply",
        "format": "npy",
        "kiosk": "1",
        "group": "1",
        "object": "1",
        "bill": "1",
        "entry": "layer-1",
        "provider": "museum",
    }
    refused = answered = 0
    for path, operations in server.contract.document["paths"].items():
        address = re.sub(r"\{(\w+)\}", lambda match: words[match[1]], path)
        for method, operation in operations.items():
            if (
                method not in ("get", "post", "put", "patch", "delete")
                or operation.get("security") == []
                or path.endswith("/live")
            ):
                continue
            answer = server.request(
                method.upper(),
                "/" + address,
                {} if method in ("post", "put", "patch") else None,
                token=secret,
            )
            if method == "get" and is_open(path):
                answered += 1
                assert answer.status == (
                    404 if "{look}" in path else 409 if path.endswith("/terms") else 200
                ), (path, answer)
                text = answer.body.decode("latin-1").lower()
                found = [
                    word
                    for word in (COLUMN, CELL, LAYER, "private.png", "carl", '"user":"owner"')
                    if word in text
                ]
                assert not found, (path, found, answer)
            else:
                refused += 1
                assert (
                    answer.status == 403 and answer.json()["title"] == "Not allowed for kiosks"
                ), (
                    method,
                    path,
                    answer,
                )
    assert answered > 15 and refused > 110, (answered, refused)
    return answered, refused


def others_closed(server, secret, files):
    """Checks that the kiosk cannot find hidden content of its model, other models, and content
    outside tours."""
    for path, status in (
        ("/models/other", 404),
        ("/models/villa-wall", 404),
        ("/models/other/layers", 404),
        ("/models/ghost", 404),
        ("/tables/ledger", 404),
        ("/tables/elsewhere/columns", 404),
        ("/tables/ledger/records/1", 404),
        ("/tables/damage/terms", 200),
        ("/tables/archive/records/1", 200),
        (f"/attachments/{files['private']}", 404),
        (f"/attachments/{files['elsewhere']}", 404),
        ("/attachments/99999999999999999999", 404),
        (f"{M}/layers/{LAYER}", 404),
        ("/tables/finds/records/1", 200),
        (f"{M}/views/west/picture?thumbnail=64", 200),
        ("/models/villa-wall/live", 426),
        (ALL + "/ghost", 404),
    ):
        answer = server.get(path, token=secret)
        assert answer.status == status, (path, answer)
    same = [
        server.get(f"/models/{ref}", token=secret).json()["detail"].replace(ref, "x")
        for ref in ("other", "ghost")
    ]
    assert same[0] == same[1], same
    assert server.request("HEAD", M, token=secret).status == 200
