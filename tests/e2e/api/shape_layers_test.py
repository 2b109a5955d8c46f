"""Layers that are computed from the shape, and layers transferred to another version of a scan."""
import math
import random
import struct

import pytest
from support.meshes import bumpy_ball, folded_grid
from support.pictures import png
from support.strata_server import wait_for

BALL, SHEET = "/models/ball", "/models/sheet"
RECIPE_MEMBERS = (
    "radius_mm",
    "distance_mm",
    "normal_scale_mm",
    "projection_scale_mm",
    "registration_mm",
    "latitude_deg",
    "north_deg",
    "from",
    "to",
    "wind_shares",
    "wind_speed_m_s",
    "rain_mm",
    "rain_mm_per_hour",
    "rays",
    "absolute",
    "model",
    "property",
    "source",
    "look",
)

# The wind from the west carries as much rain through a vertical plane as falls on the ground.
RAIN = {"wind_shares": [0, 0, 0, 0, 0, 0, 1, 0], "wind_speed_m_s": 4.5, "rain_mm": 800}


def run(server, path, body, state="done", **more):
    """Starts a job and waits for its end."""
    answer = server.ok("POST", path, body, expect=(202,), **more)
    assert answer.headers["Location"] == f"/api/v1/jobs/{answer.json()['id']}"
    job = wait_for(
        lambda: ended(server, answer.json()["id"]), f"job {answer.json()['id']}", limit_s=800
    )
    assert job["state"] == state, job
    return job


def ended(server, job):
    now = server.ok("GET", f"/jobs/{job}").json()
    return now if now["state"] not in ("queued", "running") else None


def compute(server, at, kind, **more):
    """Creates a layer from a recipe. Returns the layer and its statistics."""
    compute_members = {key: more.pop(key) for key in RECIPE_MEMBERS if key in more}
    job = run(
        server,
        at + "/layers",
        {"name": kind.replace("_", " "), "compute": {"kind": kind, **compute_members}, **more},
    )
    (layer,) = job["layers"]
    meta = server.get(f"{at}/layers/{layer}").json()
    assert meta["locked"] and not meta["visible"] and meta["description"], meta
    return meta, server.get(f"{at}/layers/{layer}/statistics").json()


@pytest.fixture(scope="module")
def server(server):
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    server.import_model(
        bumpy_ball(120, 240, radius=5.1), "larger.ply", name="Larger ball", unit="cm"
    )
    server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")
    return server


def test_refusals(server):
    def layer(**members):
        return {"name": "wrong", "compute": members}

    cases = [
        (layer(kind="beauty"), 422, "compute.kind"),
        (layer(), 422, "compute.kind"),
        (layer(kind="slope", radius_mm=3), 422, "compute.radius_mm"),
        (layer(kind="roughness", distance_mm=3), 422, "compute.distance_mm"),
        (layer(kind="roughness", radius_mm=0), 422, "compute.radius_mm"),
        (layer(kind="roughness", radius_mm=1e8), 422, "compute.radius_mm"),
        (layer(kind="mean_curvature", radius_mm=1e-6), 422, "compute.radius_mm"),
        (layer(kind="ambient_occlusion", rays=3), 422, "compute.rays"),
        (layer(kind="ambient_occlusion", rays=1e9), 422, "compute.rays"),
        (layer(kind="height", rays=64), 422, "compute.rays"),
        (layer(kind="slope", absolute=True), 422, "compute.absolute"),
        (layer(kind="model_distance"), 422, "compute.model"),
        (layer(kind="model_distance", model="nothing"), 422, "compute.model"),
        (layer(kind="change"), 422, "compute.model"),
        (layer(kind="significant_change", model="nothing"), 422, "compute.model"),
        (
            layer(kind="change", model="larger-ball", projection_scale_mm=1e-6),
            422,
            "compute.projection_scale_mm",
        ),
        (
            layer(kind="change", model="larger-ball", normal_scale_mm=1e9),
            422,
            "compute.normal_scale_mm",
        ),
        (layer(kind="change", model="larger-ball", distance_mm=1e9), 422, "compute.distance_mm"),
        (
            layer(kind="change", model="larger-ball", registration_mm=-1),
            422,
            "compute.registration_mm",
        ),
        (layer(kind="slope", registration_mm=1), 422, "compute.registration_mm"),
        (layer(kind="sun_hours"), 422, "compute.latitude_deg"),
        (layer(kind="sun_hours", latitude_deg=91), 422, "compute.latitude_deg"),
        (layer(kind="sun_hours", latitude_deg=50), 422, "compute.north_deg"),
        (layer(kind="sun_energy", latitude_deg=50, north_deg=361), 422, "compute.north_deg"),
        (
            layer(kind="sun_energy", latitude_deg=50, north_deg=0, **{"from": "02-29"}),
            422,
            "compute.from",
        ),
        (layer(kind="sun_energy", latitude_deg=50, north_deg=0, to="June"), 422, "compute.to"),
        (layer(kind="slope", latitude_deg=50), 422, "compute.latitude_deg"),
        (layer(kind="slope", to="06-01"), 422, "compute.to"),
        (layer(kind="driving_rain"), 422, "compute.wind_shares"),
        (layer(kind="driving_rain", **dict(RAIN, wind_shares=[1] * 9)), 422, "compute.wind_shares"),
        (layer(kind="driving_rain", **dict(RAIN, wind_shares=[0] * 8)), 422, "compute.wind_shares"),
        (layer(kind="driving_rain", **dict(RAIN, rain_mm=0)), 422, "compute.rain_mm"),
        (layer(kind="driving_rain", **RAIN), 422, "compute.north_deg"),
        (layer(kind="slope", rain_mm=500), 422, "compute.rain_mm"),
        (layer(kind="height", sql="x"), 422, "compute.sql"),
        (layer(kind="vertex_property"), 422, "compute.property"),
        (layer(kind="lightness", look="nothing"), 422, "compute.look"),
        (layer(kind="slope", look="nothing"), 422, "compute.look"),
        (
            {"name": "wrong", "kind": "database", "type": "u8", "compute": {"kind": "height"}},
            422,
            "kind",
        ),
        ({"name": "wrong", "resolution": 1000, "compute": {"kind": "height"}}, 422, "resolution"),
    ]
    for body, status, field in cases:
        answer = server.post(BALL + "/layers", body)
        assert answer.status == status and answer.json().get("field") == field, (body, answer)
    # errors that are found only while the job runs
    for body, field in [
        (layer(kind="boundary_distance"), "compute.kind"),
        (layer(kind="model_distance", model="ball"), "compute.model"),
        (layer(kind="change", model="ball"), "compute.model"),
        (layer(kind="vertex_property", property="quality"), "compute.property"),
        (layer(kind="lightness"), "compute.kind"),  # the scan has no colors
        ({"name": "wrong", "type": "u8", "compute": {"kind": "height", "absolute": True}}, "type"),
    ]:
        job = run(server, BALL + "/layers", body, state="failed")
        assert job["problem"]["status"] == 422 and job["problem"]["field"] == field, job
    for body, field in [
        ({"from": "nothing", "tolerance_mm": 1}, "from"),
        ({"from": "ball", "tolerance_mm": 1}, "from"),
        ({"from": "sheet"}, None),
        ({"from": "sheet", "tolerance_mm": 0}, "tolerance_mm"),
        ({"from": "larger-ball", "tolerance_mm": 1}, "from"),
        ({"from": "sheet", "tolerance_mm": 1, "layers": ["nothing"]}, "layers"),
        ({"from": "sheet", "tolerance_mm": 1, "max_angle": 0}, "max_angle"),
    ]:
        answer = server.post(BALL + "/transfer", body)
        assert answer.status == 422 and (field is None or answer.json()["field"] == field), (
            body,
            answer,
        )
    assert not [
        known for known in server.get(BALL + "/layers").json()["layers"] if known["name"] == "wrong"
    ], "nothing is left of what failed"
    print("refusals: ok", flush=True)


def test_kinds(server):
    ball = server.get(BALL).json()
    height, statistics = compute(server, BALL, "height")
    assert (height["type"], height["unit"]) == ("f32", "mm"), height
    low, high = (ball["bounds"][k][2] for k in ("min", "max"))
    assert abs(statistics["min"]) < 0.2 and abs(statistics["max"] - (high - low)) < 0.2, (
        statistics["min"],
        statistics["max"],
        low,
        high,
    )
    assert (
        abs(statistics["area_m2"] / ball["area_m2"] - 1) < 1e-3
    ), "every part of the surface has a height"
    absolute, statistics = compute(server, BALL, "height", absolute=True, name="absolute height")
    assert abs(statistics["max"] - high) < 0.2 and abs(statistics["mean"]) < 0.5, statistics
    assert absolute["name"] == "absolute height"

    # the ball is upside down, so the lowest point is now the highest
    server.ok("PATCH", BALL, {"up": "-z"})
    _, statistics = compute(server, BALL, "height", absolute=True, name="upside down")
    assert abs(statistics["max"] + low) < 0.2 and abs(statistics["min"] + high) < 0.2, (
        statistics,
        low,
        high,
    )
    _, statistics = compute(server, BALL, "height", name="upside down from the ground")
    assert abs(statistics["min"]) < 0.2 and abs(statistics["max"] - (high - low)) < 0.2, statistics
    assert server.request("PATCH", BALL, {"up": "-w"}).status == 422
    server.ok("PATCH", BALL, {"up": "z"})

    slope, statistics = compute(server, BALL, "slope")
    assert (
        slope["unit"] == "°"
        and statistics["min"] < 8
        and statistics["max"] > 172
        and abs(statistics["mean"] - 90) < 1
    ), statistics
    _, statistics = compute(server, BALL, "azimuth")
    assert 0 <= statistics["min"] < 2 and 358 < statistics["max"] <= 360, statistics
    assert (
        0 < 1 - statistics["area_m2"] / ball["area_m2"] < 0.01
    ), "only horizontal surfaces have no value"

    mean, statistics = compute(server, BALL, "mean_curvature", radius_mm=12)
    # the radius is 50 mm, with waves
    assert mean["unit"] == "1/mm" and 0.015 < statistics["mean"] < 0.025, statistics
    assert (
        mean["palette"]["min"] == -mean["palette"]["max"] and "12 mm" in mean["description"]
    ), mean
    _, gaussian = compute(server, BALL, "gaussian_curvature", radius_mm=12)
    # By the Gauss–Bonnet theorem, the integral over a closed surface without holes is 4 pi. A fit
    # over a part of a wave is not exact.
    total = gaussian["mean"] * gaussian["area_m2"] * 1e6 / (4 * math.pi)
    assert abs(total - 1) < 0.1, total
    _, largest = compute(server, BALL, "max_curvature", radius_mm=12)
    _, smallest = compute(server, BALL, "min_curvature", radius_mm=12)
    assert smallest["mean"] < statistics["mean"] < largest["mean"]
    assert abs((smallest["mean"] + largest["mean"]) / 2 - statistics["mean"]) < 1e-4
    _, rough = compute(server, BALL, "roughness", radius_mm=10)
    assert 0 <= rough["min"] and 0.1 < rough["mean"] < 0.6, rough

    openness, statistics = compute(server, SHEET, "ambient_occlusion", rays=128)
    assert (
        openness["unit"] == "" and 0 <= statistics["min"] < 0.8 and statistics["max"] > 0.95
    ), statistics
    _, rim = compute(server, SHEET, "boundary_distance")
    assert rim["min"] < 0.1 and 48 < rim["max"] < 54, rim
    # A ball in the open: half of it faces each position of the sun, and the top faces most of them.
    sunny, statistics = compute(
        server,
        BALL,
        "sun_hours",
        latitude_deg=0,
        north_deg=0,
        **{"from": "03-21", "to": "03-21"},
    )
    assert sunny["unit"] == "h" and 5.3 < statistics["mean"] < 6.1, statistics
    assert 11.5 < statistics["max"] <= 12.1 and statistics["min"] == 0, statistics
    assert "03-21" in sunny["description"], sunny
    # North can be that of the model. The sun shines from the south.
    server.ok("PATCH", BALL, {"north": "90"})
    east, statistics = compute(server, BALL, "sun_energy", latitude_deg=50)
    server.ok("PATCH", BALL, {"north": ""})
    (edit,) = server.get(f"{BALL}/layers/{east['id']}/edits").json()["edits"]
    assert edit["recipe"]["north_deg"] == 90 and edit["recipe"]["to"] == "12-31", edit
    assert east["unit"] == "kWh/m²" and 1200 < statistics["max"] < 2600, statistics
    # With north to the right (x), the side that looks to the left (-x) is in the south.
    sides = [
        server.ok("GET", f"{BALL}/layers/{east['id']}/statistics?where={where}").json()["mean"]
        for where in ("x%20%3C%20-45", "x%20%3E%2045")
    ]
    assert sides[0] > 3 * sides[1], sides
    # A ball gets a quarter of the length of the rain's vector. Its waves increase its area.
    wet, statistics = compute(server, BALL, "driving_rain", north_deg=0, **RAIN)
    assert wet["unit"] == "l/m²" and "ISO 15927-3" in wet["description"], wet
    assert 0.88 < statistics["mean"] / (math.hypot(800, 800) / 4) < 1.01, statistics
    assert statistics["min"] == 0 and 1050 < statistics["max"] < 1150, statistics
    west, east = [
        server.ok("GET", f"{BALL}/layers/{wet['id']}/statistics?where={where}").json()["mean"]
        for where in ("x%20%3C%20-45", "x%20%3E%2045")
    ]
    assert west > 600 and east < 60, (west, east)
    (edit,) = server.get(f"{BALL}/layers/{wet['id']}/edits").json()["edits"]
    assert edit["recipe"]["rain_mm_per_hour"] == 1 and edit["recipe"]["wind_shares"][6] == 1, edit
    print("kinds: ok", flush=True)


def test_distance(server):
    apart, statistics = compute(server, BALL, "model_distance", model="larger-ball")
    # the other model has the same waves at 51 mm, and its unit is the centimeter
    assert (
        apart["unit"] == "mm" and abs(statistics["mean"] + 1) < 0.05 and statistics["max"] < -0.6
    ), (statistics["mean"], statistics["max"])
    assert (
        "Larger ball" in apart["description"]
        and apart["palette"]["min"] < 0 < apart["palette"]["max"]
    ), apart
    (edit,) = server.get(f"{BALL}/layers/{apart['id']}/edits").json()["edits"]
    assert (
        edit["recipe"]["kind"] == "model_distance"
        and edit["recipe"]["model"] == "larger-ball"
        and edit["recipe"]["distance_mm"] > 0
    ), edit
    print("distance: ok", flush=True)


def test_change(server):
    """The other ball has the same waves, but its radius is 1 mm larger."""
    apart, statistics = compute(server, BALL, "change", model="larger-ball")
    assert apart["unit"] == "mm" and abs(statistics["mean"] + 1) < 0.1, statistics
    (edit,) = server.get(f"{BALL}/layers/{apart['id']}/edits").json()["edits"]
    recipe = edit["recipe"]
    assert recipe["normal_scale_mm"] > recipe["projection_scale_mm"] > 1, recipe
    assert recipe["registration_mm"] == 0 and recipe["distance_mm"] > 1, recipe
    assert "M3C2" in apart["description"] and "Larger ball" in apart["description"], apart
    scales = {"normal_scale_mm": 12, "projection_scale_mm": 6, "distance_mm": 5}
    level, statistics = compute(
        server, BALL, "level_of_detection", model="larger-ball", registration_mm=0.25, **scales
    )
    assert level["unit"] == "mm" and 1.96 * 0.25 < statistics["mean"] < 1, statistics

    def classes(registration_mm):
        layer, statistics = compute(
            server,
            BALL,
            "significant_change",
            model="larger-ball",
            name=f"registration {registration_mm}",
            registration_mm=registration_mm,
            **scales,
        )
        assert (layer["type"], layer["unit"], layer["palette"]["mode"]) == (
            "u8",
            "",
            "categorical",
        ), layer
        return {key["key"]: key["area_m2"] / statistics["area_m2"] for key in statistics["keys"]}

    assert classes(0.2).get(2, 0) > 0.9, "material was removed"
    assert set(classes(1)) == {0}, "the alignment can explain the change"
    print("change: ok", flush=True)


def test_undo(server):
    layer, before = compute(server, BALL, "slope", name="to undo")
    path = f"{BALL}/layers/{layer['id']}"
    answer = server.post(path + "/undo")
    assert answer.status == 403 and answer.json()["title"] == "Layer is locked", answer
    server.ok("PATCH", path, {"locked": False})
    server.ok("POST", path + "/undo")
    assert server.get(path + "/statistics").json()["texels"] == 0
    server.ok("POST", path + "/redo")
    assert server.get(path + "/statistics").json() == before
    server.kill()
    server.start()
    assert server.get(path + "/statistics").json() == before, "it is durable"
    print("undo: ok", flush=True)


def test_cancel(server):
    before = server.get(BALL + "/layers").json()["total"]
    answer = server.ok(
        "POST",
        BALL + "/layers",
        {
            "name": "never",
            "resolution": 4096,
            "compute": {"kind": "ambient_occlusion", "rays": 1024},
        },
    )
    server.ok("DELETE", f"/jobs/{answer.json()['id']}")
    assert server.wait_for_job(answer.json()["id"])["state"] == "cancelled"
    assert server.get(BALL + "/layers").json()["total"] == before
    print("cancel: ok", flush=True)


def test_repeats(server):
    key = {"Idempotency-Key": "one layer only"}
    body = {"name": "once", "compute": {"kind": "height"}}
    first = run(server, BALL + "/layers", body, headers=key)
    assert run(server, BALL + "/layers", body, headers=key) == first
    assert server.post(BALL + "/layers", {**body, "name": "other"}, headers=key).status == 422
    server.kill()
    server.start()
    later = run(server, BALL + "/layers", body, headers=key)
    assert later["layers"] == first["layers"], (first, later)
    assert [known["name"] for known in server.get(BALL + "/layers").json()["layers"]].count(
        "once"
    ) == 1
    print("repeats: ok", flush=True)


def with_quality(scan):
    """Returns a PLY with float positions and an additional property, which is twice the height."""
    head, body = scan.split(b"end_header\n", 1)
    count = int(head.split(b"element vertex ")[1].split()[0])
    vertices = [struct.unpack_from("<3f", body, 12 * i) for i in range(count)]
    head = head.replace(
        b"property float z\n", b"property float z\nproperty double quality\nproperty uchar red\n"
    )
    return (
        head
        + b"end_header\n"
        + b"".join(struct.pack("<3fdB", *v, 2 * v[2], 7) for v in vertices)
        + body[12 * count :]
    )


def test_lightness(server):
    """The left half of the scan is gray, the right half is white. A surface image is red."""
    scan = folded_grid(color_at=lambda x, y: (119,) * 3 if x < 50 else (255,) * 3)
    server.import_model(scan, "colored.ply", name="Colored", unit="mm")
    model = "/models/colored"
    layer, values = compute(server, model, "lightness", name="Of the scan")
    assert "visible colors" in layer["description"] and layer["palette"]["max"] == 100, layer
    assert abs(values["min"] - 50.03) < 0.05 and abs(values["max"] - 100) < 0.05, values
    picture = png(32, 32, lambda x, y: (255, 0, 0))
    server.ok(
        "POST", model + "/looks?name=Red+light", picture, headers={"Content-Type": "image/png"}
    )
    layer, values = compute(server, model, "lightness", look="red-light", name="Of the image")
    assert "Red light" in layer["description"], layer
    assert max(abs(values[of] - 53.24) for of in ("min", "mean", "max")) < 0.01, values
    # Without colors of the scan, a place has no lightness where the image is transparent.
    server.import_model(folded_grid(), "plain.ply", name="Plain", unit="mm")
    picture = png(64, 64, lambda x, y: (255, 0, 0, 255 if x < 32 else 0))
    look = server.ok(
        "POST", "/models/plain/looks?name=Half", picture, headers={"Content-Type": "image/png"}
    ).json()
    server.ok("PATCH", f"/models/plain/looks/{look['id']}", {"visible": True})
    _, values = compute(server, "/models/plain", "lightness")
    whole = server.get("/models/plain").json()["area_m2"]
    assert abs(values["mean"] - 53.24) < 0.01, values
    assert 0.1 * whole < values["area_m2"] < 0.9 * whole, (values, whole)
    # The image is hidden by default.
    _, values = compute(server, model, "lightness", name="Once more")
    assert abs(values["max"] - 100) < 0.05, values


def test_vertex_property(server):
    server.import_model(with_quality(bumpy_ball()), "ball.ply", name="With quality", unit="mm")
    model = "/models/with-quality"
    assert server.get(model + "/vertex-properties").json() == {
        "properties": [{"source": "ball.ply", "property": "quality"}],
        "total": 1,
    }
    assert server.get(BALL + "/vertex-properties").json()["total"] == 0
    layer, quality = compute(
        server, model, "vertex_property", property="quality", unit="lux", name="Light"
    )
    assert layer["unit"] == "lux" and "quality" in layer["description"], layer
    _, height = compute(server, model, "height", absolute=True)
    assert (
        abs(quality["min"] - 2 * height["min"]) < 1e-3
        and abs(quality["max"] - 2 * height["max"]) < 1e-3
    )
    assert (
        abs(quality["mean"] - 2 * height["mean"]) < 1e-4
        and abs(quality["area_m2"] - height["area_m2"]) < 1e-12
    )
    # the same numbers from a file, one per line, in the order of the scan's vertices
    scan = bumpy_ball()
    head, body = scan.split(b"end_header\n", 1)
    count = int(head.split(b"element vertex ")[1].split()[0])
    heights = [struct.unpack_from("<3f", body, 12 * i)[2] for i in range(count)]
    server.ok("POST", model + "/layers", {"name": "From CSV", "type": "f32"})
    path = model + "/layers/from-csv"
    csv = "quality\n" + "".join(f"{2 * z}\r\n" for z in heights)
    edit = server.ok("PUT", path + "/vertices.csv", csv.encode()).json()
    statistics = server.get(path + "/statistics").json()
    assert (
        edit["texels_changed"] == statistics["texels"]
        and abs(statistics["mean"] - quality["mean"]) < 1e-4
    ), (edit, statistics["mean"])
    assert (
        abs(statistics["max"] - quality["max"]) < 1e-3
        and abs(statistics["area_m2"] - quality["area_m2"]) < 1e-12
    )
    server.ok("POST", path + "/undo")
    assert server.get(path + "/statistics").json()["texels"] == 0
    # Whole numbers are keys, so there are no values between them. The area around a vertex without
    # a key gets the keys of its neighbors.
    server.ok("POST", model + "/layers", {"name": "Sides", "type": "u8"})
    sides = "".join("\n" if abs(z) < 10 else ("7\n" if z > 0 else "200\n") for z in heights)
    server.ok("PUT", model + "/layers/sides/vertices.csv?source=ball.ply", sides.encode())
    keys = {
        key["key"]: key["area_m2"]
        for key in server.get(model + "/layers/sides/statistics").json()["keys"]
    }
    assert set(keys) == {7, 200} and abs(keys[7] / keys[200] - 1) < 0.02, keys
    cases = [
        (b"", 400, "body"),
        (b"1\n2\n", 422, "body"),
        (csv.encode() + b"5\n", 422, "body"),
        (csv.replace("quality", "1").encode(), 422, "body"),
        (b"1\nx\n", 422, "body"),
        ("".join("300\n" for _ in heights).encode(), 422, "body"),
        ("".join("0.5\n" for _ in heights).encode(), 422, "body"),
        (b"1\ninf\n", 422, "body"),
        (b"\xff\xfe\n\x00\n", 422, "body"),
    ]
    for body, status, field in cases:
        answer = server.request("PUT", model + "/layers/sides/vertices.csv", body)
        assert answer.status == status and answer.json()["field"] == field, (body[:40], answer)
    assert (
        server.request(
            "PUT", model + "/layers/sides/vertices.csv?source=other.ply", sides.encode()
        ).json()["field"]
        == "source"
    )
    print("vertex property: ok", flush=True)


def test_transfer(server):
    """Classes of height are transferred to a scan with another tessellation, atlas and unit, and
    with the noise of scanning."""
    source = server.import_model(bumpy_ball(60, 120), "then.ply", name="Then", unit="mm")
    palette = {
        "mode": "categorical",
        "min": 0,
        "max": 104,
        "points": [{"at": 1, "color": "#112233", "label": "one"}],
    }
    compute(
        server,
        "/models/then",
        "height",
        type="u8",
        name="Classes",
        unit="cm",
        palette=palette,
        opacity=0.5,
    )
    compute(server, "/models/then", "slope", name="Slope")
    now = server.import_model(
        noisy(bumpy_ball(97, 211, radius=5.0), 0.002), "now.ply", name="Now", unit="cm"
    )
    job = run(server, "/models/now/transfer", {"from": "then", "tolerance_mm": 1})
    report = job["report"]
    assert report["from"] == source["id"] and report["matched_m2"] / now["area_m2"] > 0.999, report
    # the layers keep their order: the layer that was computed last is the lowest
    assert [layer["name"] for layer in report["layers"]] == ["Slope", "Classes"] and [
        layer["layer"] for layer in report["layers"]
    ] == job["layers"]
    for layer in report["layers"]:
        assert (
            layer["lost_m2"] <= 1e-3 * layer["source_m2"]
            and abs(layer["transferred_m2"] / layer["source_m2"] - 1) < 0.01
        ), layer
    classes = server.get("/models/now/layers/classes").json()
    assert (classes["type"], classes["unit"], classes["opacity"]) == ("u8", "cm", 0.5) and classes[
        "palette"
    ]["points"] == [{"at": 1, "color": "#112233ff", "label": "one"}], classes
    assert "Then" in classes["description"], classes
    keys = [
        {
            key["key"]: key["area_m2"]
            for key in server.get(f"/models/{model}/layers/classes/statistics").json()["keys"]
        }
        for model in ("then", "now")
    ]
    assert len(keys[0]) > 90 and keys[0].keys() == keys[1].keys(), keys
    worst = max(
        abs(keys[1][key] / keys[0][key] - 1)
        for key in keys[0]
        if keys[0][key] > 0.005 * source["area_m2"]
    )
    print(f"transfer: {len(keys[0])} keys, largest difference of area {100 * worst:.2f} %")
    assert worst < 0.02, worst
    # undo works as for every other edit
    server.ok("POST", "/models/now/layers/classes/undo")
    assert server.get("/models/now/layers/classes/statistics").json()["texels"] == 0

    # Half of the ball is missing, and the report lists its content as lost.
    half = bumpy_ball(97, 211)
    server.import_model(cut_below(half), "half.ply", name="Half", unit="mm")
    job = run(
        server,
        "/models/half/transfer",
        {"from": "then", "tolerance_mm": 0.5, "layers": ["classes"]},
    )
    (layer,) = job["report"]["layers"]
    assert (
        abs(layer["lost_m2"] / layer["source_m2"] - 0.5) < 0.05
        and abs(layer["transferred_m2"] / layer["source_m2"] - 0.5) < 0.05
    ), layer
    job = run(
        server,
        "/models/larger-ball/transfer",
        {"from": "then", "tolerance_mm": 0.2, "layers": ["classes"]},
    )
    (layer,) = job["report"]["layers"]
    assert (
        layer["transferred_m2"] == 0
        and layer["lost_m2"] == layer["source_m2"]
        and job["report"]["matched_m2"] == 0
    ), "it lies a millimetre away"
    print("transfer: ok", flush=True)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()


def noisy(scan, amplitude):
    """Moves every vertex by up to `amplitude` along each axis, identically in every run."""
    head, body = scan.split(b"end_header\n", 1)
    count = int(head.split(b"element vertex ")[1].split()[0])
    shake = random.Random(11)
    moved = (
        value + amplitude * shake.uniform(-1, 1)
        for value in struct.unpack_from(f"<{3 * count}f", body)
    )
    return head + b"end_header\n" + struct.pack(f"<{3 * count}f", *moved) + body[12 * count :]


def cut_below(scan):
    """Removes the faces below the plane z = 0."""
    head, body = scan.split(b"end_header\n", 1)
    count, faces = (
        int(head.split(b"element %s " % name)[1].split()[0]) for name in (b"vertex", b"face")
    )
    heights = [struct.unpack_from("<3f", body, 12 * i)[2] for i in range(count)]
    records = [body[12 * count + 13 * i : 12 * count + 13 * (i + 1)] for i in range(faces)]
    kept = [
        record
        for record in records
        if all(heights[v] >= 0 for v in struct.unpack_from("<3i", record, 1))
    ]
    return (
        head.replace(b"element face %d" % faces, b"element face %d" % len(kept))
        + b"end_header\n"
        + body[: 12 * count]
        + b"".join(kept)
    )
