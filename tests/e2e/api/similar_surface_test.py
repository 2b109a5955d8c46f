"""Selection of surface that looks like the surface at a point, over HTTP: by color, normal and
value, and painted as one edit."""
import math
import random

import pytest
from support.cameras import camera_from
from support.meshes import bumpy_ball, folded_grid
from support.pictures import png
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
DISCS = ((40, 50, 15), (80, 50, 8))  # red discs on gray: x, y, radius in mm
IMAGE = {"Content-Type": "image/png"}


def color_at(noise):
    def color(x, y):
        is_red = any(math.hypot(x - cx, y - cy) <= radius for cx, cy, radius in DISCS)
        base = (170, 70, 60) if is_red else (190, 185, 175)
        return [channel + noise.randint(-8, 8) for channel in base]

    return color


def like(x=40, y=50, by="color", tolerance=20, **more):
    point = [x, y, 0]
    return {"within": {"like": {"at": {"point": point}, "by": by, "tolerance": tolerance, **more}}}


def select(server, body):
    return server.ok("POST", M + "/select", body).json()


def disc_m2(radius_mm):
    return math.pi * radius_mm**2 * 1e-6


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), (a, b)


def texels(server, layer):
    return server.get(f"{M}/layers/{layer}/statistics").json()["texels"]


def newest(server, layer):
    return server.get(f"{M}/layers/{layer}/edits").json()["edits"][0]


@pytest.fixture(scope="module")
def server(server):
    sheet = folded_grid(cells=200, fold=0.001, color_at=color_at(random.Random(1)))
    server.import_model(sheet, "sheet.ply", name="Sheet", unit="mm", resolution=2048)
    for name, kind in (("Damage", "u8"), ("Depth", "f32"), ("Secret", "u8")):
        server.ok("POST", M + "/layers", {"name": name, "type": kind, "resolution": 2048})
    server.ok("PATCH", M + "/layers/secret", {"visibility": "private"})
    return server


def test_a_disc_is_selected_by_its_color(server):
    selected = select(server, {**like(), "layers": ["damage"]})
    near(selected["area_m2"], disc_m2(15), 0.05)
    assert selected["bounds"]["min"][0] > 23 and selected["bounds"]["max"][0] < 57, selected
    near(select(server, like(radius_mm=5))["area_m2"], disc_m2(5), 0.05)
    both = select(server, like(contiguous=False))
    near(both["area_m2"], disc_m2(15) + disc_m2(8), 0.06)
    near(select(server, like(contiguous=False, radius_mm=25))["area_m2"], disc_m2(15), 0.05)
    assert select(server, like(tolerance=200))["share"] > 0.999


def test_a_place_can_be_a_pixel_of_a_view(server):
    camera = camera_from(server.get(M).json(), (0, 0, 1), 800, 800, up=(0, 1, 0))
    found = server.ok("POST", M + "/pick", {"camera": camera, "x": 320, "y": 400}).json()[
        "position"
    ]
    by_point = select(server, like(found[0], found[1]))
    body = like()
    body["within"]["like"]["at"] = {"camera": camera, "x": 320, "y": 400}
    picture = {"camera": camera, "width": 200, "height": 200}
    by_pixel = select(server, {**body, "picture": picture})
    assert by_pixel["texels"] == by_point["texels"] and by_pixel["picture"]


def test_a_brush_selects_similar_surface_along_its_path(server):
    camera = camera_from(server.get(M).json(), (0, 0, 1), 800, 800, up=(0, 1, 0))

    def pixel_of(x, y):
        # the view is straight from above, so pixels are linear in x and y
        a, b = (
            server.ok("POST", M + "/pick", {"camera": camera, "x": px, "y": px}).json()["position"]
            for px in (200, 600)
        )
        return [200 + 400 * (v - a[i]) / (b[i] - a[i]) for i, v in enumerate((x, y))]

    # from the middle of the disc with radius 15 through its rim, and beyond
    path = [pixel_of(40, 50 + step) for step in range(31)]
    at = {"camera": camera, "x": path[0][0], "y": path[0][1]}
    brushed = like(path=path, radius_mm=4)
    brushed["within"]["like"]["at"] = at
    strip = sum(  # of the disc, 8 mm wide, from a half disc below the middle to the rim
        0.1 * 0.1e-6
        for i in range(-150, 151)
        for j in range(-150, 151)
        if (x := i / 10) ** 2 + (y := j / 10) ** 2 <= 225
        and abs(x) <= 4
        and (y >= 0 or x * x + y * y <= 16)
    )
    near(select(server, brushed)["area_m2"], strip, 0.06)
    # pixels off the model do not count
    brushed["within"]["like"]["path"] = [[-50.0, -50.0], *path, [-60.0, 900.0]]
    near(select(server, brushed)["area_m2"], strip, 0.06)
    # the value at the beginning is compared, also if the path is elsewhere
    brushed["within"]["like"]["path"] = [pixel_of(80, 50)]
    near(select(server, brushed)["area_m2"], disc_m2(4), 0.06)
    brushed["within"]["like"]["path"] = [pixel_of(60, 20)]
    assert select(server, brushed)["texels"] == 0
    painted = select(server, {**brushed, "into": {"layer": "damage", "value": 2}})
    assert painted["edit"]["texels_changed"] == 0
    for change, field in (
        ({"at": {"point": [40, 50, 0]}}, "within.like.at"),
        ({"radius_mm": None}, "within.like.radius_mm"),
        ({"path": []}, "within.like.path"),
    ):
        wrong = {key: value for key, value in (brushed["within"]["like"] | change).items() if value}
        if change.get("path") == []:
            wrong["path"] = []
        answer = server.post(M + "/select", {"within": {"like": wrong}})
        assert answer.status == 422 and answer.json()["field"] == field, answer


def test_a_surface_image_can_be_compared_even_if_it_is_hidden(server):
    image = png(64, 64, lambda x, y: (90, 90, 90))
    made = server.ok("POST", M + "/looks?name=UV", image, headers=IMAGE).json()
    assert not made["visible"]
    assert select(server, like(look="uv"))["share"] > 0.999
    near(select(server, like())["area_m2"], disc_m2(15), 0.05)
    server.ok("PATCH", M + "/looks/uv", {"visible": True})
    assert select(server, like())["share"] > 0.999
    # the discs show through an image that is not opaque
    server.ok("PATCH", M + "/looks/uv", {"opacity": 0.05})
    near(select(server, like())["area_m2"], disc_m2(15), 0.05)
    assert select(server, like(look="uv"))["share"] > 0.999
    server.ok("DELETE", M + "/looks/uv")
    near(select(server, like())["area_m2"], disc_m2(15), 0.05)
    assert server.post(M + "/select", like(look="uv")).json()["field"] == "within.like.look"


def test_normals_and_values_are_compared(server):
    assert select(server, like(by="normal", tolerance=10))["share"] > 0.999
    dab(server, f"{M}/layers/depth", 1, 30, 30, 10)
    dab(server, f"{M}/layers/depth", 1.5, 45, 30, 10)
    dab(server, f"{M}/layers/depth", 9, 70, 30, 10)
    depth = {"by": "value", "layer": "depth"}
    one = select(server, like(30, 30, tolerance=0.1, **depth))["area_m2"]
    two = select(server, like(30, 30, tolerance=0.6, **depth))["area_m2"]
    near(two, one + disc_m2(10), 0.01)  # the second disc is above a part of the first one
    near(select(server, like(70, 30, tolerance=0.6, **depth))["area_m2"], disc_m2(10), 0.05)
    rest = select(server, like(10, 90, tolerance=100, **depth))["area_m2"]  # without a value
    near(rest + two + disc_m2(10), select(server, {})["area_m2"], 0.01)


def test_a_selection_is_painted_as_one_edit_that_can_be_undone(server):
    body = {**like(), "layers": ["damage"], "into": {"layer": "damage", "value": 3}}
    key = {"Idempotency-Key": "wand-1"}
    done = server.ok("POST", M + "/select", body, headers=key).json()
    assert done["edit"]["texels_changed"] == done["texels"] == texels(server, "damage"), done
    assert newest(server, "damage")["op"] == "fill"
    again = server.ok("POST", M + "/select", body, headers=key).json()
    assert again["edit"]["sequence"] == done["edit"]["sequence"]
    erase = {**like(radius_mm=5), "into": {"layer": "damage", "erase": True}}
    erased = select(server, erase)["edit"]
    near(erased["area_m2"], disc_m2(5), 0.05)
    assert texels(server, "damage") == done["texels"] - erased["texels_changed"]
    server.ok("POST", f"{M}/layers/damage/undo")
    assert texels(server, "damage") == done["texels"]
    server.ok("POST", f"{M}/layers/damage/undo")
    assert texels(server, "damage") == 0


def test_other_parts_of_the_surface_can_be_painted_too(server):
    around = {"within": {"at": {"point": [50, 50, 0]}, "radius_mm": 10}}
    done = select(server, {**around, "into": {"layer": "damage", "value": 4}})
    near(done["edit"]["area_m2"], disc_m2(10), 0.03)
    camera = camera_from(server.get(M).json(), (0, 0, 1), 640, 480, up=(0, 1, 0))
    outline = {"camera": camera, "path": [[300, 200], [340, 200], [340, 280], [300, 280]]}
    done = select(server, {"within": outline, "into": {"layer": "damage", "value": 5}})
    assert done["edit"]["texels_changed"] == done["texels"] > 0, done


def test_the_texels_of_the_painted_layer_are_counted(server):
    server.ok("POST", M + "/layers", {"name": "Fine", "type": "u8", "resolution": 4096})
    around = {"within": {"at": {"point": [50, 50, 0]}, "radius_mm": 10}}
    for area in (like(), around, {"where": "depth > 0"}):
        done = select(server, {**area, "into": {"layer": "fine", "value": 2}})
        assert done["resolution"] == 4096, done
        assert done["edit"]["texels_changed"] == done["texels"] == texels(server, "fine"), done
        server.ok("POST", f"{M}/layers/fine/undo")
    finer = {**like(), "layers": ["fine"], "into": {"layer": "damage", "value": 2}}
    done = select(server, finer)
    assert done["resolution"] == 4096 and done["edit"]["texels_changed"] < done["texels"], done
    near(done["edit"]["area_m2"], done["area_m2"], 0.05)
    server.ok("POST", f"{M}/layers/damage/undo")


def test_refusals(server):
    into = {"layer": "damage", "value": 1}
    for body, field in (
        (like(by="value"), "within.like.layer"),
        (like(by="value", layer="nothing"), "within.like.layer"),
        (like(layer="depth"), "within.like.layer"),
        (like(by="normal", look="uv"), "within.like.look"),
        ({**like(), "where": "true", "into": into}, "into"),
        ({**like(), "at": 1, "into": into}, "into"),
        ({**like(by="value", layer="secret"), "into": into}, "within.like.layer"),
        ({**like(), "into": {"layer": "damage", "value": 999}}, "value"),
    ):
        answer = server.post(M + "/select", body)
        assert answer.status in (404, 422) and answer.json()["field"].startswith(field), (
            body,
            answer,
        )
    assert select(server, like(by="value", layer="secret"))["share"] > 0.999


def test_a_model_without_colors_is_refused(server):
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    body = like(0, 0)
    answer = server.post("/models/ball/select", body)
    assert answer.status == 422 and answer.json()["field"] == "within.like.by", answer
    near(
        server.ok("POST", "/models/ball/select", like(0, 0, by="normal", tolerance=180)).json()[
            "share"
        ],
        1,
        1e-6,
    )
