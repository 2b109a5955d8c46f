"""Locked layers, over HTTP and live: annotators cannot change texels in any way, and curators
can."""
import hashlib
import urllib.parse
import uuid

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.maps import square, tiff
from support.meshes import folded_grid
from support.strata_server import wait_for

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
L = M + "/layers/cracks"
CELLS = 21  # number of vertices per side
KEPT = "kept-for-repeats"


def query(path, **parameters):
    return path + "?" + urllib.parse.urlencode(parameters)


def geojson(value, x, y, size):
    return {
        "type": "Feature",
        "properties": {"value": value},
        "geometry": {"type": "Polygon", "coordinates": [[list(p) for p in square(x, y, size)]]},
    }


def texels(server, layer):
    return hashlib.sha256(server.ok("GET", f"{M}/layers/{layer}/texels.npy").body).hexdigest()


def state(server):
    """Returns the content that must not change: the texels and history of all layers, and the
    records."""
    layers = [each["slug"] for each in server.get(M + "/layers").json()["layers"]]
    return (
        {
            layer: (texels(server, layer), server.get(f"{M}/layers/{layer}/edits").json()["total"])
            for layer in layers
        },
        server.get("/tables/units/edits").json()["total"],
        [each["key"] for each in server.get("/tables/units/records").json()["records"]],
    )


def lock(server, layer, locked=True):
    now = server.ok("PATCH", f"{M}/layers/{layer}", {"locked": locked}).json()
    assert now["locked"] is locked and server.get(f"{M}/layers/{layer}").json()["locked"] is locked
    return now


def is_refused(answer, name):
    problem = answer.json()
    assert (
        answer.status == 403
        and problem["detail"] == f"The layer {name} is locked. Ask a curator to unlock it."
    ), answer
    assert problem["title"] == "Layer is locked" and problem["field"] == "layer", answer


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    legend = {"mode": "categorical", "points": [{"at": 5, "color": "#112233", "label": "Moss"}]}
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Units", "kind": "database", "type": "u16", "palette": legend},
    )
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Open units", "kind": "database", "type": "u16", "table": "units"},
    )
    for name in ("First", "Second"):
        server.ok("POST", "/tables/units/records", {"values": {"name": name}})
    return server


@pytest.fixture(scope="module")
def camera(server):
    return camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))


def token_of(server, role):
    return server.ok("POST", "/me/tokens", {"name": role, "role": role}).json()["secret"]


@pytest.fixture(scope="module")
def viewer(server):
    return token_of(server, "viewer")


@pytest.fixture(scope="module")
def annotator(server):
    return token_of(server, "annotator")


@pytest.fixture(scope="module")
def curator(server):
    return token_of(server, "curator")


def test_doors(server, annotator, curator, camera):
    """Over HTTP. Each operation changes texels if a curator calls it."""
    seen = {"camera": camera}
    stroke = {"op": "stroke", "value": 11, **seen, "radius_px": 8, "path": [[300, 200], [340, 220]]}
    first = server.ok("POST", L + "/edits", stroke, token=annotator).json()["sequence"]
    server.ok("POST", L + "/edits", {**stroke, "value": 12, "path": [[320, 260]]}, token=annotator)
    raster = {
        ending: server.ok("GET", f"{L}/texels.{ending}").body for ending in ("npy", "png", "tif")
    }
    server.ok("POST", L + "/edits", {**stroke, "value": 13, "path": [[360, 260]]}, token=annotator)
    server.ok("POST", L + "/undo", token=annotator)
    vertices = "".join(f"{n % 7}\n" for n in range(CELLS * CELLS)).encode()
    fill = {"op": "fill", "mode": "where", "where": "cracks > 0", "value": 14}
    map_file = {"Content-Type": "application/geo+json"}
    doors = [
        ("redo", "POST", L + "/redo", None, {}),
        ("undo", "POST", L + "/undo", None, {}),
        ("stroke", "POST", L + "/edits", {**stroke, "value": 15}, {}),
        (
            "eraser",
            "POST",
            L + "/edits",
            {"op": "stroke", "erase": True, **seen, "radius_mm": 2, "path": [[320, 210]]},
            {},
        ),
        (
            "polygon",
            "POST",
            L + "/edits",
            {"op": "polygon", "value": 16, **seen, "path": [[250, 200], [390, 200], [320, 300]]},
            {},
        ),
        ("fill where", "POST", L + "/edits", fill, {}),
        (
            "fill of a connected place",
            "POST",
            L + "/edits",
            {"op": "fill", "mode": "connected", "value": 17, "at": {**seen, "x": 320, "y": 240}},
            {},
        ),
        (
            "fill of an island",
            "POST",
            L + "/edits",
            {"op": "fill", "mode": "island", "value": 18, "at": {"point": [50, 50, 0]}},
            {},
        ),
        ("texels.npy", "PUT", L + "/texels.npy", raster["npy"], {}),
        ("vertices.csv", "PUT", L + "/vertices.csv", vertices, {}),
        ("texels.png", "PUT", L + "/texels.png", raster["png"], {}),
        (
            "readings",
            "POST",
            query(L + "/readings", radius_mm=4),
            b"x,y,z,value\n20,20,0,19\n",
            {"Content-Type": "text/csv"},
        ),
        ("texels.tif", "PUT", L + "/texels.tif", raster["tif"], {}),
        (
            "a map of polygons",
            "POST",
            query(L + "/polygons", value=20),
            geojson(1, 10, 10, 20),
            map_file,
        ),
        (
            "a map of pixels",
            "POST",
            L + "/picture",
            tiff(2, 2, lambda x, y: 21, kind="B", scale=10.0, origin=(40, 60)),
            {"Content-Type": "image/tiff"},
        ),
        (
            "select into",
            "POST",
            M + "/select",
            {"where": "cracks = 20", "into": {"layer": "cracks", "value": 22}},
            {},
        ),
        ("restore", "POST", L + "/restore", {"sequence": first}, {}),
    ]
    lock(server, "cracks")
    before = state(server)
    for what, method, path, body, headers in doors:
        is_refused(server.request(method, path, body, headers=headers, token=annotator), "Cracks")
        assert state(server) == before, what
    for what, method, path, body, headers in doors:
        then = texels(server, "cracks")
        answer = server.request(method, path, body, headers=headers, token=curator)
        assert answer.status == 200, (what, answer)
        assert texels(server, "cracks") != then, what
    lock(server, "cracks", False)
    server.ok("POST", L + "/edits", stroke, token=annotator)
    print("doors: ok", flush=True)


def test_settings(server, annotator, viewer):
    """Only curators can change a layer's settings, locked or not."""
    for locked in (False, True):
        lock(server, "cracks", locked)
        before = server.get(L).json()
        for token in (annotator, viewer):
            for change in (
                {"locked": not locked},
                {"name": "Mine"},
                {"description": "x"},
                {"unit": "m"},
                {"visible": False},
                {"opacity": 0.1},
                {"order": 9},
                {"type": "u16"},
                {"palette": before["palette"]},
                {"expression": "1"},
            ):
                assert server.request("PATCH", L, change, token=token).status == 403, change
            assert server.request("DELETE", L, token=token).status == 403
            assert (
                server.post(M + "/layers", {"name": "New", "locked": False}, token=token).status
                == 403
            )
        assert server.get(L).json() == before
    assert (
        server.post(
            L + "/edits", {"op": "fill", "mode": "where", "where": "true", "value": 1}, token=viewer
        ).status
        == 403
    )
    stale = server.get(L).headers["ETag"]
    lock(server, "cracks", False)
    assert server.request("PATCH", L, {"locked": True}, headers={"If-Match": stale}).status == 412
    made = server.ok("POST", M + "/layers", {"name": "Handed in", "locked": True}).json()
    assert made["locked"] is True
    is_refused(
        server.post(
            f"{M}/layers/handed-in/edits",
            {"op": "fill", "mode": "where", "where": "true", "value": 1},
            token=annotator,
        ),
        "Handed in",
    )
    server.ok("DELETE", f"{M}/layers/handed-in")
    print("settings: ok", flush=True)


def new():
    return str(uuid.uuid4())


def test_live(server, annotator, curator, camera):
    lock(server, "cracks", False)
    with LiveClient(server, "sheet", token=annotator) as ada, LiveClient(
        server, "sheet", token=curator
    ) as carl:
        assert {each["slug"]: each["locked"] for each in ada.hello()["layers"]}["cracks"] is False
        carl.hello()

        def begin(live, value):
            stroke = new()
            live.send(
                {
                    "op": "stroke.begin",
                    "id": new(),
                    "stroke": stroke,
                    "layer": "cracks",
                    "value": value,
                    "camera": camera,
                    "radius_px": 9,
                }
            )
            return stroke

        def extend(live, stroke, n, place):
            live.send(
                {"op": "stroke.extend", "id": new(), "stroke": stroke, "n": n, "path": [place]}
            )
            return live.receive_until("saved", "problem")

        # The layer is locked while Ada paints. The saved parts remain, the rest is refused, and she
        # gets the reason.
        stroke = begin(ada, 41)
        saved = extend(ada, stroke, 0, [200, 200])
        assert saved["op"] == "saved", saved
        lock(server, "cracks")
        event = ada.receive_until("layer")
        while event["event"] != "changed":
            event = ada.receive_until("layer")
        assert event["layer"]["locked"] is True, event
        before = state(server)
        refused = extend(ada, stroke, 1, [260, 260])
        assert refused["op"] == "problem" and refused["status"] == 403, refused
        assert (
            refused["title"] == "Layer is locked"
            and "Ask a curator to unlock it" in refused["detail"]
            and refused["field"] == "layer"
        ), refused
        changes = [
            {"op": "undo"},
            {"op": "redo"},
            {"op": "edit", "edit": {"op": "fill", "mode": "where", "where": "true", "value": 42}},
            {
                "op": "edit",
                "edit": {
                    "op": "stroke",
                    "value": 43,
                    "camera": camera,
                    "radius_px": 9,
                    "path": [[300, 300]],
                },
            },
            {
                "op": "edit",
                "edit": {
                    "op": "polygon",
                    "value": 44,
                    "camera": camera,
                    "path": [[250, 200], [390, 200], [320, 300]],
                },
            },
        ]
        for change in changes:
            message = {**change, "id": new(), "layer": "cracks"}
            ada.send(message)
            problem = ada.receive_until("saved", "problem")
            assert (
                problem["op"] == "problem"
                and problem["status"] == 403
                and problem["ref"] == message["id"]
            ), (change, problem)
        again = begin(ada, 45)
        assert extend(ada, again, 0, [210, 300])["status"] == 403
        assert state(server) == before
        # curators can edit as if the layer were not locked
        assert extend(carl, begin(carl, 46), 0, [320, 320])["op"] == "saved"
        for change in [{"op": "undo"}, {"op": "redo"}] + changes[2:]:
            carl.send({**change, "id": new(), "layer": "cracks"})
            assert carl.receive_until("saved", "problem")["op"] == "saved", change
        lock(server, "cracks", False)
        assert extend(ada, begin(ada, 47), 0, [330, 200])["op"] == "saved"
    print("live: ok", flush=True)


def test_records(server, annotator, curator):
    """A record that is painted on a locked layer keeps its texels on every layer."""
    for layer in ("units", "open-units"):
        server.ok(
            "POST",
            query(f"{M}/layers/{layer}/polygons", value=1),
            geojson(1, 10, 10, 20),
            headers={"Content-Type": "application/geo+json"},
        )
    lock(server, "units")
    before = state(server)
    for texels_go in ("texels=clear", "texels=reassign&to=2"):
        for path in ("/tables/units/records/1?", M + "/layers/open-units/records/1?"):
            is_refused(server.request("DELETE", path + texels_go, token=annotator), "Units")
            assert state(server) == before, texels_go
    # the record still exists, and can be painted and changed as before
    server.ok(
        "POST",
        M + "/layers/open-units/edits",
        {"op": "fill", "mode": "where", "where": '"open-units" = 1', "value": 1},
        token=annotator,
    )
    server.ok("PATCH", "/tables/units/records/1", {"values": {"name": "One"}}, token=annotator)
    # a map also adds no records for a layer that the user may not paint
    body, headers = geojson(5, 60, 60, 20), {"Content-Type": "application/geo+json"}
    before = state(server)
    is_refused(
        server.request(
            "POST",
            query(M + "/layers/units/polygons", attribute="value"),
            body,
            headers=headers,
            token=annotator,
        ),
        "Units",
    )
    assert state(server) == before
    server.ok(
        "POST",
        query(M + "/layers/units/polygons", attribute="value"),
        body,
        headers=headers,
        token=curator,
    )
    assert server.get("/tables/units/records/5").json()["values"]["name"] == "Moss"
    then = texels(server, "units")
    server.ok("DELETE", "/tables/units/records/1?texels=reassign&to=2", token=curator)
    assert texels(server, "units") != then and server.get("/tables/units/records/1").status == 404
    then = texels(server, "units")
    server.ok("DELETE", "/tables/units/records/2?texels=clear", token=curator)
    assert texels(server, "units") != then
    print("records: ok", flush=True)


def test_computed(server, annotator, curator):
    server.ok("POST", M + "/layers", {"name": "Twice", "expression": "cracks * 2"})
    assert server.get(M + "/layers/twice").json()["locked"] is True, "what was computed is locked"
    change = lambda value: server.ok(
        "POST",
        query(L + "/readings", radius_mm=4),
        f"x,y,z,value\n80,80,0,{value}\n",
        headers={"Content-Type": "text/csv"},
    )
    change(30)
    then = texels(server, "twice")
    is_refused(server.post(M + "/layers/twice/compute", token=annotator), "Twice")
    assert (
        texels(server, "twice") == then and server.get(M + "/layers/twice").json()["stale"] is True
    )
    server.ok("POST", M + "/layers/twice/compute", token=curator)
    then = texels(server, "twice")
    # the server itself may update the computed layer, because the lock applies only to users
    server.ok("PATCH", M + "/layers/twice", {"recompute": "automatic"})
    change(31)
    wait_for(lambda: texels(server, "twice") != then, "a locked automatic layer to follow")
    assert server.get(M + "/layers/twice").json()["locked"] is True
    # a user who copies layers to another scan can paint the copies
    server.import_model(folded_grid(fold=0.001), "again.ply", name="Again", unit="mm")
    job = server.wait_for_job(
        server.ok(
            "POST",
            "/models/again/transfer",
            {"from": "sheet", "layers": ["twice"], "tolerance_mm": 1},
        ).json()["id"]
    )
    assert (
        job["state"] == "done"
        and server.get(f"/models/again/layers/{job['layers'][0]}").json()["locked"] is False
    ), job
    print("computed: ok", flush=True)


def test_repeats(server, annotator):
    """A repeat of an edit that was saved before the lock gets the first response, even after a
    restart."""
    edit = {"op": "fill", "mode": "where", "where": "cracks > 0", "value": 50}
    send = lambda: server.post(
        L + "/edits", edit, headers={"Idempotency-Key": KEPT}, token=annotator
    )
    first = send().json()
    lock(server, "cracks")
    for restarted in (False, True):
        if restarted:
            assert server.stop() == 0
            server.start()
        again = send()
        assert again.status == 200 and again.json() == first, again
        assert server.get(L).json()["locked"] is True
        is_refused(server.post(L + "/undo", token=annotator), "Cracks")
    print("repeats: ok", flush=True)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
