"""Areas on the unrolled sheet of a vessel, over HTTP: selected, and painted as one edit, which can be
undone, reviewed and repeated like other edits."""
import math

import numpy
import pytest
from support.meshes import bumpy_ball, pillar, vessel
from support.pictures import pixels

RED = {"mode": "categorical", "points": [{"at": 1, "color": "#ff0000"}]}
AXIS = {"point": [0, 0, 40], "direction": [0, 0, 1]}
WIDTH = 2 * math.pi * 40  # of the sheet of the column, in mm


def box(left, bottom, right, top):
    return [[left, bottom], [right, bottom], [right, top], [left, top]]


def select(server, model, unrolled, expect=200, **more):
    answer = server.request(
        "POST", f"/models/{model}/select", {"within": {"unrolled": unrolled}, **more}
    )
    assert answer.status == expect, (unrolled, answer)
    return answer.json()


def area_mm2(answer):
    return answer["area_m2"] * 1e6


def painted_mm2(server, model="column", layer="marks"):
    return server.ok("GET", f"/models/{model}/layers/{layer}/statistics").json()["area_m2"] * 1e6


def history(server, model="column", layer="marks"):
    return server.ok("GET", f"/models/{model}/layers/{layer}/edits").json()


def near(value, expected, share=0.01):
    assert abs(value - expected) <= share * expected, (value, expected)


@pytest.fixture(scope="module")
def server(server):
    for name, slope in (("column", 0.0), ("bowl", 0.2)):
        server.import_model(vessel(slope=slope), f"{name}.ply", name=name, unit="mm")
        server.ok(
            "POST",
            f"/models/{name}/layers",
            {"name": "Marks", "type": "u8", "resolution": 2048, "palette": RED},
        )
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    server.import_model(pillar(), "pillar.ply", name="Pillar", unit="mm")
    return server


INTO = {"layer": "marks", "value": 1}


def test_an_area_around_the_edges_of_a_pillar_has_its_area(server):
    around = {"shape": "general_cylinder"}
    # 80 mm reach around both edges of the front, which is 60 mm wide.
    answer = select(server, "pillar", {**around, "polygons": [box(-40, -10, 40, 10)]})
    near(area_mm2(answer), 80 * 20)
    # The whole walls, also across the cut.
    answer = select(server, "pillar", {**around, "polygons": [box(-150, -100, 150, 100)]})
    near(area_mm2(answer), 200 * 80)
    # The sheet of a response can be used again.
    sheet = server.ok(
        "POST", "/models/pillar/rollout", around, headers={"Accept": "application/json"}
    ).json()
    again = {"axis": sheet["axis"], "side": sheet["side"], "cut": sheet["from"], **around}
    near(area_mm2(select(server, "pillar", {**again, "polygons": [box(-40, -10, 40, 10)]})), 1600)


def test_a_rectangle_has_its_area_and_is_one_durable_edit(server):
    before = history(server)["total"]
    body = {"axis": AXIS, "polygons": [box(-30, -15, 30, 25)]}
    answer = select(server, "column", body, into=INTO)
    near(area_mm2(answer), 60 * 40)
    edit = answer["edit"]
    near(edit["area_m2"] * 1e6, 60 * 40)
    assert edit["texels_changed"] == answer["texels"], answer
    near(painted_mm2(server), 60 * 40)
    entries = history(server)
    assert entries["total"] == before + 1
    newest = entries["edits"][0]
    assert newest["sequence"] == edit["sequence"] and newest["op"] == "fill", newest
    # undo and redo change exactly this edit
    server.ok("POST", "/models/column/layers/marks/undo")
    assert painted_mm2(server) == 0
    server.ok("POST", "/models/column/layers/marks/redo")
    near(painted_mm2(server), 60 * 40)
    erased = select(server, "column", body, into={"layer": "marks", "erase": True})
    assert erased["edit"]["texels_changed"] == edit["texels_changed"], erased
    assert painted_mm2(server) == 0


def test_the_painted_area_is_where_the_rollout_shows_it(server):
    body = {"axis": AXIS, "radius": 40, "side": "outside", "cut": 90}
    strokes = [{"path": [[-60, -20], [20, 25]], "radius_mm": 5}]
    select(server, "column", {**body, "strokes": strokes}, into=INTO)
    answer = server.request(
        "POST",
        "/models/column/rollout",
        {**body, "mm_per_pixel": 0.5, "relief": False},
        headers={"Accept": "image/png"},
    )
    rows = numpy.array(pixels(answer.body, slice(0, 4)))
    red = (rows[:, :, 0] > 200) & (rows[:, :, 1] < 60)
    y, x = numpy.mgrid[0 : rows.shape[0], 0 : rows.shape[1]]
    x, y = (x + 0.5) * 0.5 - WIDTH / 2, 40 - (y + 0.5) * 0.5
    along = numpy.clip(((x + 60) * 80 + (y + 20) * 45) / (80**2 + 45**2), 0, 1)
    distance = numpy.hypot(x + 60 - 80 * along, y + 20 - 45 * along)
    clear = abs(distance - 5) > 0.7  # not at the border of the stroke
    assert (red == (distance < 5))[clear].all()
    server.ok("POST", "/models/column/layers/marks/undo")


@pytest.mark.parametrize("side_of_cut", [-1, 1])
def test_an_area_continues_past_the_cut(server, side_of_cut):
    end = side_of_cut * WIDTH / 2
    body = {"axis": AXIS, "polygons": [box(end - 20, -10, end + 20, 10)]}
    answer = select(server, "column", body, layers=["marks"])
    near(area_mm2(answer), 40 * 20)
    # both halves are at the back
    assert answer["bounds"]["min"][1] > 30, answer["bounds"]
    disc = {"axis": AXIS, "strokes": [{"path": [[end, 0]], "radius_mm": 12}]}
    near(area_mm2(select(server, "column", disc)), math.pi * 144)


def test_a_cone_has_the_areas_of_its_sheet(server):
    sheet = server.request(
        "POST", "/models/bowl/rollout", {}, headers={"Accept": "application/json"}
    ).json()
    assert sheet["shape"] == "cone", sheet
    fixed = {name: sheet[name] for name in ("axis", "radius", "half_angle", "side")} | {
        "cut": sheet["from"]
    }
    for body in ({}, fixed):
        near(area_mm2(select(server, "bowl", {**body, "polygons": [box(-25, -15, 25, 20)]})), 1750)
    disc = {**fixed, "strokes": [{"path": [[40, 10]], "radius_mm": 10}]}
    near(area_mm2(select(server, "bowl", disc)), math.pi * 100)


def test_an_area_on_the_sheet_is_combined_with_conditions(server):
    below = {"where": "z < 40"}
    sheet = {"unrolled": {"axis": AXIS, "polygons": [box(-30, -10, 30, 20)]}}
    parts = [{"within": sheet}, {"combine": "intersect", "within": below}]
    answer = server.ok(
        "POST", "/models/column/select", {"within": {"parts": parts}, "into": INTO}
    ).json()
    near(area_mm2(answer), 60 * 10)
    assert answer["bounds"]["max"][2] < 40, answer
    server.ok("POST", "/models/column/layers/marks/undo")


def test_a_repeated_request_is_one_edit(server):
    before = history(server)["total"]
    key = {"Idempotency-Key": "unroll once"}
    body = {
        "within": {"unrolled": {"strokes": [{"path": [[0, 0]], "radius_mm": 4}]}},
        "into": INTO,
    }
    first = server.ok("POST", "/models/column/select", body, headers=key).json()
    again = server.ok("POST", "/models/column/select", body, headers=key).json()
    assert again["edit"]["sequence"] == first["edit"]["sequence"], (first, again)
    assert history(server)["total"] == before + 1
    server.ok("POST", "/models/column/layers/marks/undo")


def test_an_area_waits_for_review_on_a_reviewed_layer(server):
    server.ok(
        "POST",
        "/models/column/layers",
        {"name": "Checked", "type": "u8", "resolution": 2048, "review": True},
    )
    anna = server.add_person("anna", "annotator")
    answer = server.ok(
        "POST",
        "/models/column/select",
        {
            "within": {"unrolled": {"strokes": [{"path": [[0, 0]], "radius_mm": 4}]}},
            "into": {"layer": "checked", "value": 1},
        },
        token=anna,
    ).json()
    assert answer["edit"]["provisional"], answer
    server.ok(
        "POST", "/models/column/layers/checked/review", {"decision": "reject", "user": "anna"}
    )
    assert painted_mm2(server, layer="checked") == 0


def test_viewers_and_locked_layers_are_refused(server):
    body = {
        "within": {"unrolled": {"strokes": [{"path": [[0, 0]], "radius_mm": 4}]}},
        "into": INTO,
    }
    vera = server.add_person("vera", "viewer")
    assert server.request("POST", "/models/column/select", body, token=vera).status == 403
    only_selects = {"within": body["within"]}
    assert server.request("POST", "/models/column/select", only_selects, token=vera).status == 200
    server.ok("PATCH", "/models/column/layers/marks", {"locked": True})
    bo = server.add_person("bo", "annotator")
    assert server.request("POST", "/models/column/select", body, token=bo).status == 403
    server.ok("PATCH", "/models/column/layers/marks", {"locked": False})


def test_faulty_areas_name_the_field(server):
    dab = [{"path": [[0, 0]], "radius_mm": 4}]
    line = [[i * 0.01, 0] for i in range(4096)]
    for model, field, body in (
        ("column", "radius", {"radius": 5, "strokes": dab}),
        ("column", "side", {"side": "inside", "strokes": dab}),
        (
            "column",
            "axis.direction",
            {"axis": {"point": [0, 0, 0], "direction": [0, 0, 0]}, "strokes": dab},
        ),
        ("column", "polygons[0]", {"polygons": [[[0, 0], [1, 1]]]}),
        ("column", "strokes[0].radius_mm", {"strokes": [{"path": [[0, 0]], "radius_mm": 0}]}),
        ("ball", "axis", {"strokes": dab}),
    ):
        problem = select(server, model, body, expect=422)
        assert problem["field"] == f"within.unrolled.{field}", (body, problem)
    many = {"strokes": [{"path": line, "radius_mm": 1}] * 5}
    assert select(server, "column", many, expect=422)["field"] == "within.unrolled"
    # with an axis, every model can be unrolled
    assert (
        area_mm2(select(server, "ball", {"axis": AXIS | {"point": [0, 0, 0]}, "strokes": dab})) > 0
    )


def test_an_area_can_be_saved_as_a_selection(server):
    within = {"unrolled": {"axis": AXIS, "polygons": [box(-30, -15, 30, 25)]}}
    saved = server.ok(
        "POST",
        "/models/column/selections",
        {"name": "Field", "audience": "everyone", "within": within},
    ).json()
    answer = server.ok(
        "POST", "/models/column/select", {"within": {"selection": saved["slug"]}}
    ).json()
    near(area_mm2(answer), 60 * 40)


def test_a_line_on_the_sheet_is_on_the_wall(server):
    path = [[-30, -10], [30, -10], [30, 10]]
    body = {"unrolled": {"axis": AXIS, "radius": 40, "path": path}, "step_mm": 1, "layers": []}
    profile = server.ok("POST", "/models/column/profile", body).json()
    assert len(profile["samples"]) == 60 + 20 + 1
    assert profile["length_mm"] == pytest.approx(80, rel=0.01)
    for sample in profile["samples"]:
        x, y, _ = sample["point"]["position"]
        near(math.hypot(x, y), 40)
    first, last = (profile["samples"][i]["point"]["position"] for i in (0, -1))
    assert first[2] == pytest.approx(30, abs=0.01) and last[2] == pytest.approx(50, abs=0.01)
    turn = math.atan2(last[1], last[0]) - math.atan2(first[1], first[0])
    assert turn % (2 * math.pi) == pytest.approx(60 / 40, abs=0.01)
    body["unrolled"]["path"] = [[0, 0], [0, 1000]]
    assert not server.ok("POST", "/models/column/profile", body).json()["samples"][-1]["point"][
        "hit"
    ]


@pytest.mark.parametrize(
    "change, field",
    [
        ({"step_mm": 1e-4}, "step_mm"),
        ({"unrolled": {"radius": 40, "path": [[0, 0], [1, 0]]}}, "unrolled.radius"),
        ({"unrolled": {"axis": AXIS}}, "unrolled"),
        ({"places": [[0, 0, 0], [1, 0, 0]]}, None),
    ],
)
def test_wrong_lines_on_the_sheet_are_refused(server, change, field):
    body = {"unrolled": {"axis": AXIS, "path": [[0, 0], [9, 0]]}, "step_mm": 1, **change}
    answer = server.request("POST", "/models/column/profile", body)
    assert answer.status == 422, answer
    if field:
        assert answer.json()["field"].startswith(field), answer
