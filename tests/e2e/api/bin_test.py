"""The trash: no operation returns deleted content. Deleted content survives kill -9, is restored
with texels, history and values, and is erased when its time in the trash ends."""
import pytest
from support.cameras import camera_from
from support.kiosk_site import make_kiosk
from support.live_client import LiveClient, Refused
from support.meshes import folded_grid
from support.sql_reader import Reader, free_port
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"
BIN = "/projects/default/bin"
FILL = {"op": "fill", "mode": "where", "where": "true", "value": 1}
LINE = {"places": [[10, 10, 0], [90, 90, 0]], "step_mm": 1}


class Site:
    def __init__(self, server, port):
        self.server, self.port = server, port
        self.tokens = {
            name: server.add_person(name, role)
            for name, role in (("vera", "viewer"), ("ada", "annotator"), ("carl", "curator"))
        }
        self.model = server.import_model(
            folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
        )
        self.camera = camera_from(self.model, (0, 0, 1), up=(0, 1, 0))
        self.layer = self.ok(
            "carl", "POST", M + "/layers", {"name": "Cracks", "type": "u8", "resolution": 2048}
        ).json()
        stroke = {
            "op": "stroke",
            "value": 3,
            "camera": self.camera,
            "radius_px": 20,
            "path": [[300, 200], [340, 260]],
        }
        for value in (3, 7):
            self.ok("ada", "POST", M + "/layers/cracks/edits", {**stroke, "value": value})
        self.ok(
            "carl",
            "PATCH",
            M + "/layers/cracks",
            {"locked": True, "visibility": "team", "description": "By eye"},
        )
        self.ok(
            "carl", "POST", M + "/layers", {"name": "Graves", "type": "u8", "visibility": "private"}
        )
        self.ok(
            "carl",
            "POST",
            M + "/layers",
            {
                "name": "Units",
                "kind": "database",
                "type": "u16",
                "resolution": 2048,
                "columns": [{"name": "Name", "unique": True}],
            },
        )
        self.ok(
            "ada",
            "POST",
            "/tables/units/records",
            {"records": [{"values": {"name": f"SU {n}"}} for n in (1, 2)]},
        )
        self.ok(
            "ada",
            "POST",
            M + "/views",
            {
                "name": "Front",
                "camera": self.camera,
                "layers": [{"layer": "cracks", "visible": True}],
            },
        )
        self.ok(
            "ada",
            "POST",
            M + "/comments",
            {"text": "A crack?", "position": [50, 50, 0], "layer": "cracks"},
        )

    def ask(self, who, method, path, body=None, **more):
        return self.server.request(method, path, body, token=self.tokens[who], **more)

    def ok(self, who, method, path, body=None, **more):
        return self.server.ok(method, path, body, token=self.tokens[who], **more)

    def listed(self, who="carl"):
        return self.ok(who, "GET", BIN).json()["entries"]

    def state(self):
        """Returns the state of the layer: its members, history, texels, values and a frame, and all
        references to it."""
        layer = self.ok("carl", "GET", M + "/layers/cracks").json()
        return {
            "layer": layer,
            "history": self.ok("carl", "GET", M + "/layers/cracks/edits").json(),
            "texels": self.ok("carl", "GET", M + "/layers/cracks/texels.npy").body,
            "values": self.ok(
                "carl", "POST", M + "/profile", {**LINE, "layers": ["cracks"]}
            ).json(),
            "picture": self.ok(
                "carl", "POST", M + "/frame", {"camera": self.camera, "format": "png"}
            ).body,
            "views": self.ok("carl", "GET", M + "/views").json(),
            "comments": self.ok("ada", "GET", M + "/comments").json(),
        }


def doors_of_layer(site):
    """No operation returns a layer in the trash, even for the owner."""
    server, layer = site.server, site.layer
    for ref in ("cracks", layer["id"]):
        at = f"{M}/layers/{ref}"
        doors = [
            ("GET", at, None),
            ("PATCH", at, {"opacity": 1}),
            ("DELETE", at, None),
            ("GET", at + "/edits", None),
            ("POST", at + "/edits", FILL),
            ("POST", at + "/undo", None),
            ("POST", at + "/redo", None),
            ("GET", at + "/statistics", None),
            ("GET", at + "/texels.npy", None),
            ("POST", M + "/profile", {**LINE, "layers": [str(ref)]}),
            ("POST", M + "/frame", {"camera": site.camera, "layers": [{"layer": str(ref)}]}),
            (
                "POST",
                M + "/select",
                {"where": f"{'cracks' if ref == 'cracks' else 'layer_' + str(ref)} > 1"},
            ),
        ]
        for method, path, body in doors:
            answer = server.request(method, path, body)
            assert answer.status in (400, 404, 422), (method, path, answer)
    assert "cracks" not in [
        each["slug"] for each in server.ok("GET", M + "/layers").json()["layers"]
    ]
    shown = server.ok("GET", M + "/views/front").json()
    assert all(each["layer"] not in ("cracks", layer["id"]) for each in shown["layers"]), shown
    thread = server.ok("GET", M + "/comments").json()["comments"][0]
    assert "layer" not in thread, thread
    assert not Reader(server, site.port).rows("SELECT * FROM layers WHERE slug = 'cracks'")
    assert not Reader(server, site.port).rows("SELECT * FROM edits WHERE layer = 'Cracks'")
    lines = server.ok("GET", "/projects/default/activity?limit=100").json()["activity"]
    assert all("layer" not in line for line in lines if line.get("name") == "Cracks"), lines


@pytest.fixture(scope="module")
def site():
    port = free_port()
    with StrataServer(options=["--sql-listen", f"127.0.0.1:{port}"]) as server:
        yield Site(server, port)


def test_layers(site):
    """A layer is deleted and restored unchanged, even after kill -9. While it is in the trash, its
    name is free."""
    server = site.server
    before = site.state()
    with LiveClient(server, "sheet") as live:
        live.hello(dpr=1, accept=["jpeg"])
        site.ok("carl", "DELETE", M + "/layers/cracks", headers={"If-Match": "*"})
        while live.receive_until("layer")["event"] != "deleted":
            pass
        doors_of_layer(site)
        site.ok("ada", "POST", M + "/layers/units/edits", {**FILL, "value": 1})
    server.kill()
    server.start()
    doors_of_layer(site)
    entry = site.listed()[0]
    assert (entry["id"], entry["name"], entry["user"], entry["model_name"]) == (
        f"layer-{site.layer['id']}",
        "Cracks",
        "carl",
        "Sheet",
    ), entry
    assert entry["bytes"] > 0 and entry["deleted"] < entry["erased"], entry
    with LiveClient(server, "sheet") as live:
        live.hello(dpr=1, accept=["jpeg"])
        restored = site.ok("carl", "POST", f"{BIN}/{entry['id']}/restore").json()
        assert restored == {
            "kind": "layer",
            "restored": site.layer["id"],
            "name": "Cracks",
            "slug": "cracks",
            "model": site.model["id"],
        }, restored
        told = live.receive_until("layer")
        assert told["event"] == "created" and told["layer"]["slug"] == "cracks", told
    site.ok("ada", "POST", M + "/layers/units/undo")
    after = site.state()
    for what, value in before.items():
        assert after[what] == value, (what, value, after[what])
    assert not site.listed()
    # the history continues, and another restart changes nothing
    site.ok("carl", "PATCH", M + "/layers/cracks", {"locked": False})
    site.ok("ada", "POST", M + "/layers/cracks/undo")
    assert site.ok("carl", "GET", M + "/layers/cracks/texels.npy").body != before["texels"]
    site.ok("ada", "POST", M + "/layers/cracks/redo")
    server.kill()
    server.start()
    assert site.ok("carl", "GET", M + "/layers/cracks/texels.npy").body == before["texels"]
    # another layer takes the slug while this layer is in the trash
    site.ok("carl", "DELETE", M + "/layers/cracks")
    assert (
        site.ok("carl", "POST", M + "/layers", {"name": "Cracks", "type": "u8"}).json()["slug"]
        == "cracks"
    )
    again = site.ok(
        "carl",
        "POST",
        f"{BIN}/layer-{site.layer['id']}/restore",
        headers={"Idempotency-Key": "back"},
    ).json()
    assert (again["slug"], again["former_slug"]) == ("cracks-2", "cracks"), again
    assert (
        site.ok(
            "carl",
            "POST",
            f"{BIN}/layer-{site.layer['id']}/restore",
            headers={"Idempotency-Key": "back"},
        ).json()
        == again
    )
    site.ok("carl", "DELETE", M + "/layers/cracks")


def test_models(site):
    """A model is deleted and restored with all its content."""
    server = site.server
    site.ok("carl", "DELETE", f"{BIN}/{site.listed()[0]['id']}")
    before = [
        site.ok("carl", "GET", M + path).body
        for path in (
            "/layers",
            "/layers/cracks-2/texels.npy",
            "/views",
            "/comments",
            "/source/sheet.ply",
        )
    ]
    server.ok(
        "POST",
        M + "/tours",
        {
            "name": "Round",
            "languages": ["en"],
            "stops": [{"view": "front", "title": {"en": "The front"}}],
        },
    )
    _, link = make_kiosk(server, M + "/tours/round")
    with LiveClient(server, "sheet") as live:
        live.hello(dpr=1, accept=["jpeg"])
        site.ok("carl", "DELETE", M, headers={"If-Match": "*"})
        while live.receive_until("model", "problem").get("event") != "deleted":
            pass
    for path in (
        M,
        f"/models/{site.model['id']}",
        M + "/layers",
        M + "/views",
        M + "/comments",
        M + "/source/sheet.ply",
        "/comments/1",
        M + "/events",
    ):
        assert server.get(path).status == 404, path
    assert server.post("/auth/kiosk", {"link": link}, token=False).status in (
        401,
        404,
    ), "a kiosk of a model in the Bin"
    try:
        LiveClient(server, "sheet")
        raise AssertionError("the model is in the Bin")
    except Refused as refused:
        assert refused.status == 404, refused
    assert server.ok("GET", "/models").json()["models"] == []
    assert not Reader(server, site.port).rows("SELECT * FROM models") and not Reader(
        server, site.port
    ).rows("SELECT * FROM layers")
    server.kill()
    server.start()
    entries = site.listed()
    assert [entry["id"] for entry in entries] == [f"model-{site.model['id']}"], entries
    assert entries[0]["bytes"] > 1000, entries
    site.ok("carl", "POST", f"{BIN}/{entries[0]['id']}/restore")
    assert [
        site.ok("carl", "GET", M + path).body
        for path in (
            "/layers",
            "/layers/cracks-2/texels.npy",
            "/views",
            "/comments",
            "/source/sheet.ply",
        )
    ] == before
    assert (
        server.post("/auth/kiosk", {"link": link}, token=False).status == 200
    ), "the links of kiosks come back"
    told = [
        (line["kind"], line["op"])
        for line in server.ok("GET", "/projects/default/activity?limit=2").json()["activity"]
    ]
    assert told == [("model", "restored"), ("model", "deleted")], told


def test_records(site):
    """Users who may delete a record can restore it with its key and values, once its values are
    valid."""
    table = site.ok("ada", "GET", "/tables/units").json()["id"]
    before = site.ok("ada", "GET", "/tables/units/records/1").json()
    site.ok("ada", "POST", M + "/layers/units/edits", {**FILL, "value": 1})
    site.ok("ada", "DELETE", "/tables/units/records/1?texels=clear")
    entry = site.listed("ada")[0]
    assert (entry["id"], entry["name"], entry["table_name"], entry["user"]) == (
        f"record-{table}-1",
        "SU 1",
        "Units",
        "ada",
    ), entry
    assert site.ask("carl", "DELETE", f"{BIN}/{entry['id']}").status == 409, "history keeps it"
    taken = site.ok("ada", "POST", "/tables/units/records", {"values": {"name": "SU 1"}}).json()
    refused = site.ask("ada", "POST", f"{BIN}/{entry['id']}/restore")
    assert (
        refused.status == 409
        and f"Record {taken['key']} already has this value" in refused.json()["detail"]
    ), refused
    site.ok("ada", "PATCH", f"/tables/units/records/{taken['key']}", {"values": {"name": "SU 9"}})
    assert site.ok("ada", "POST", f"{BIN}/{entry['id']}/restore").json() == {
        "kind": "record",
        "restored": 1,
        "name": "SU 1",
        "table": table,
    }
    after = site.ok("ada", "GET", "/tables/units/records/1").json()
    assert after["values"] == before["values"], after
    assert not site.listed("ada")
    # the layer may contain texels with the record's key again
    site.ok("ada", "POST", M + "/layers/units/edits", {**FILL, "value": 1})
    assert site.ask("ada", "POST", f"{BIN}/{entry['id']}/restore").status == 404


def test_roles(site):
    """Users who may not delete can neither see nor restore deleted content. Invalid requests are
    refused."""
    site.ok("carl", "DELETE", M + "/layers/graves")
    entry = site.listed()[0]["id"]
    assert site.listed("ada") == [], "layers are for curators"
    for who, status in (("vera", 403), ("ada", 404)):
        assert site.ask(who, "POST", f"{BIN}/{entry}/restore").status == status, who
    assert (
        site.ask("vera", "GET", BIN).status == 403
        and site.ask("ada", "DELETE", f"{BIN}/{entry}").status == 403
    )
    lines = site.ok("ada", "GET", "/projects/default/activity?limit=1000").json()["activity"]
    assert all(
        line.get("name") != "Graves" for line in lines
    ), "a private layer in the Bin is private"
    for wrong in (
        "layer-",
        "layer-x",
        "layer-99999",
        "model-1-2",
        "record-1",
        "layer--1",
        "1",
        "layer-1%00",
        "layer-" + "9" * 40,
        "record-1-" + "9" * 30,
    ):
        assert site.ask("carl", "POST", f"{BIN}/{wrong}/restore").status in (400, 404), wrong
    assert site.ask("carl", "GET", BIN + "?limit=0").status in (400, 422) and site.ask(
        "carl", "GET", BIN + "?what=1"
    ).status in (400, 422)
    site.server.ok("POST", "/projects", {"name": "Villa"})
    assert (
        site.ask("carl", "POST", f"/projects/villa/bin/{entry}/restore").status == 404
    ), "of another project"
    site.ok("carl", "POST", f"{BIN}/{entry}/restore")


def test_expiry(site):
    """The next start erases all expired content and nothing else. Users can erase content
    immediately."""
    server = site.server
    for name in ("Old", "Young", "Gone"):
        site.ok("carl", "POST", M + "/layers", {"name": name, "type": "u8", "resolution": 2048})
        site.ok("ada", "POST", f"{M}/layers/{name.lower()}/edits", FILL)
        site.ok("carl", "DELETE", f"{M}/layers/{name.lower()}")
    by_name = {entry["name"]: entry["id"] for entry in site.listed()}
    site.ok("carl", "DELETE", f"{BIN}/{by_name['Gone']}")
    assert site.ask("carl", "POST", f"{BIN}/{by_name['Gone']}/restore").status == 404
    server.sql(
        "UPDATE all_layers SET binned = now() - interval '8 days' WHERE name = 'Old'; UPDATE all_layers SET binned = now() - interval '6 days' WHERE name = 'Young'"
    )
    assert server.stop() == 0
    server.options += ["--bin-days", "7"]
    server.start()
    wait_for(
        lambda: server.sql("SELECT count(*) FROM all_layers WHERE name IN ('Old', 'Gone')") == "0",
        "what is over to be erased",
    )
    assert (
        server.sql(
            "SELECT count(*) FROM tile_revisions r WHERE NOT EXISTS (SELECT 1 FROM all_layers l WHERE l.id = r.layer_id)"
        )
        == "0"
    )
    listed = server.ok("GET", BIN).json()
    assert [entry["name"] for entry in listed["entries"]] == ["Young"] and listed[
        "days"
    ] == 7, listed
    site.ok("carl", "POST", f"{BIN}/{by_name['Young']}/restore")
    assert site.ok("carl", "GET", M + "/layers/young/statistics").json()
    # with 0 days, the trash keeps nothing
    assert server.stop() == 0
    server.options[-1] = "0"
    server.start()
    site.ok("carl", "DELETE", M)
    wait_for(
        lambda: server.sql(
            "SELECT (SELECT count(*) FROM all_models) + (SELECT count(*) FROM blobs)"
        )
        == "0",
        "the model to be erased",
    )
    assert server.ok("GET", BIN).json()["entries"] == []


def test_the_server_ends_with_a_clean_log(site):
    server = site.server
    assert server.stop() == 0
    server.assert_clean_log()
