"""Records in queries, over HTTP: filters of tables, columns in conditions, and layers that are
computed from other layers, from records and from the surface."""
import math
import urllib.parse

import pytest
from support.meshes import folded_grid
from support.strata_server import wait_for

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm


def dab(server, layer, value, x, y, radius):
    query = urllib.parse.urlencode({"radius_mm": radius})
    return server.ok(
        "POST",
        f"{M}/layers/{layer}/readings?{query}",
        f"x,y,z,value\n{x},{y},0,{value}\n",
        headers={"Content-Type": "text/csv"},
    ).json()


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), (a, b)


def select(server, where, **more):
    return server.ok("POST", M + "/select", {"where": where, **more}).json()["area_m2"]


def value(server, layer, x, y):
    point = urllib.parse.urlencode({"coords": f"POINT Z({x} {y} 0)", "parameter-name": layer})
    return server.get(f"{M}/position?{point}").json()["values"][layer]


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    columns = [
        {"name": "Name"},
        {"name": "Thickness", "kind": "numeric", "unit": "mm"},
        {"name": "State", "kind": "enumeration", "choices": ["loose", "firm"]},
        {"name": "Period", "kind": "period"},
    ]
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Pieces",
            "kind": "database",
            "type": "u16",
            "resolution": 2048,
            "columns": columns,
        },
    )
    server.ok("POST", M + "/layers", {"name": "Wet", "type": "f32", "resolution": 2048})
    for values in (
        {"name": "Head", "thickness": 4, "state": "loose", "period": "1560~"},
        {"name": "Foot", "thickness": 8, "state": "firm"},
        {"name": "Hand", "thickness": 2, "period": "1700/.."},
    ):
        server.ok("POST", "/tables/pieces/records", {"values": values})
    dab(server, "pieces", 1, 30, 30, 10)
    dab(server, "pieces", 2, 70, 30, 6)
    dab(server, "pieces", 3, 70, 70, 6)
    dab(server, "wet", 0.75, 35, 30, 20)
    dab(server, "wet", 0.25, 25, 22, 20)
    dab(server, "wet", 0.75, 30, 30, 5)
    return server


def fill_wet(server, value):
    server.ok(
        "POST",
        M + "/layers/wet/edits",
        {"op": "fill", "mode": "where", "where": "valid(wet)", "value": value},
    )


def test_filters(server):
    def keys(text, path="/tables/pieces", **more):
        query = urllib.parse.urlencode({"filter": text, **more})
        answer = server.ok("GET", f"{path}/records?{query}").json()
        return [each["key"] for each in answer["records"]], answer["total"]

    assert keys("thickness > 3 and state like 'l%'") == ([1], 1)
    assert keys("thickness is not null", sortby="-thickness", limit=1) == ([2], 3)
    assert keys("t_before(period, '1600') or casei(name) = 'hand'", path=M + "/layers/pieces") == (
        [1, 3],
        2,
    )
    csv = server.ok(
        "GET", "/tables/pieces/records?f=csv&" + urllib.parse.urlencode({"filter": "thickness < 5"})
    ).body.decode("utf-8-sig")
    assert len(csv.strip().split("\r\n")) == 3, csv
    for text, offset, says in (
        ("thick > 3", 0, "no column 'thick'"),
        ("thickness > ", 12, "the end"),
        ("state = 'lose'", 8, "not a choice"),
        ("name = 'ä' and thickness = 'x'", 15, "holds numbers"),
        ("1=1; drop table records.t1", 3, "no meaning"),
    ):
        answer = server.get("/tables/pieces/records?" + urllib.parse.urlencode({"filter": text}))
        problem = answer.json()
        assert (
            answer.status == 422
            and problem["field"] == "filter"
            and problem["offset"] == offset
            and says in problem["detail"]
        ), problem


def test_conditions(server):
    fill_wet(server, 0.25)
    dab(server, "wet", 0.75, 30, 30, 5)
    near(select(server, "pieces.thickness > 3"), (100 + 36) * math.pi * 1e-6, 0.03)
    near(select(server, "pieces.state = 'loose' and wet > 0.5"), 25 * math.pi * 1e-6, 0.03)
    near(select(server, "x < 50 and y < 50 and z < 1"), 2500e-6, 0.01)
    answer = server.post(M + "/select", {"where": "wet > 0 and pieces.thick > 1"})
    assert (
        answer.status == 422 and answer.json()["offset"] == 12 and answer.json()["field"] == "where"
    ), answer
    answer = server.post(M + "/select", {"where": "slope > 3"})
    assert answer.status == 422 and "computed layers" in answer.json()["detail"], answer
    assert answer.json()["reason"] == "computed_layers_only"


def test_mistakes_are_corrected(server):
    for text, reason, suggestions in (
        ("wte > 0", "unknown_layer", ["wet"]),
        ("wet > 0 and peices.thickness > 1", "unknown_layer", ["pieces.thickness"]),
        ("wet > 0 and pieces.thikness > 1", "unknown_column", ["pieces.thickness"]),
        ("pieces.state = 'lose'", "unknown_choice", ["'loose'"]),
        ("vaild(wet)", "unknown_function", ["valid"]),
        ("wet > 3 mm", "unit", ["3"]),
        ("wet", "expects_condition", None),
    ):
        problem = server.post(M + "/select", {"where": text}).json()
        assert problem["status"] == 422 and problem["reason"] == reason, problem
        assert problem.get("suggestions") == suggestions, problem
        if suggestions is None:
            continue
        assert "Did you mean " + suggestions[0] in problem["detail"], problem
        begin, length = problem["offset"], problem["length"]
        corrected = text[:begin] + suggestions[0] + text[begin + length :]
        server.ok("POST", M + "/select", {"where": corrected})


def compute(server, name, expression, expect=201, **more):
    return server.ok(
        "POST",
        M + "/layers",
        {"name": name, "expression": expression, "resolution": 2048, **more},
        expect=(expect,),
    ).json()


def test_computing(server):
    fill_wet(server, 0.75)
    risk = compute(server, "Risk", "if(pieces.state = 'loose', 10, 1) * wet")
    assert (
        risk["expression"].startswith("if(")
        and risk["type"] == "f32"
        and risk["locked"]
        and not risk["visible"]
    ), risk
    assert (risk["inputs"], risk["stale"], risk["recompute"]) == (
        ["pieces", "wet"],
        False,
        "manual",
    ), risk
    assert value(server, "risk", 30, 30) == {"valid": True, "value": 7.5}
    assert value(server, "risk", 90, 10)["valid"] is False
    assert server.get(M + "/layers/risk/edits").json()["edits"][0]["op"] == "compute"

    # after a change to a record or to texels, the layer is stale until it is computed again
    server.ok("PATCH", "/tables/pieces/records/1", {"values": {"state": "firm"}})
    assert server.get(M + "/layers/risk").json()["stale"] is True
    assert value(server, "risk", 30, 30)["value"] == 7.5
    assert server.ok("POST", M + "/layers/risk/compute").json()["stale"] is False
    assert value(server, "risk", 30, 30)["value"] == 0.75
    dab(server, "wet", 0.25, 30, 30, 2)
    assert {
        each["slug"]: each.get("stale") for each in server.get(M + "/layers").json()["layers"]
    } == {"pieces": None, "wet": None, "risk": True}
    server.ok("POST", M + "/layers/risk/compute")
    assert (
        value(server, "risk", 30, 30)["value"] == 0.25
        and server.get(M + "/layers/risk").json()["stale"] is False
    )

    # conditions, types, and the surface
    mask = compute(server, "Mask", "risk > 0.5", type="u8")
    assert mask["inputs"] == ["risk"] and value(server, "mask", 30, 38) == {
        "valid": True,
        "value": 1,
    }
    assert not value(server, "mask", 30, 30)["valid"] and not value(server, "mask", 90, 10)["valid"]
    compute(server, "Rounded", "x / 10", type="u8")
    assert (
        value(server, "rounded", 47, 50)["value"] == 5
        and value(server, "rounded", 44, 50)["value"] == 4
    )
    total = server.get(M).json()["area_m2"]
    texel = compute(server, "Texel", "area")
    statistics = server.get(f"{M}/layers/{texel['slug']}/statistics").json()
    near(statistics["mean"] * statistics["texels"], total, 0.05)
    job = compute(server, "Steep", "if(slope < 45 and nz > 0.7, height, 0)", expect=202)
    done = server.wait_for_job(job["id"])
    assert done["state"] == "done" and len(done["layers"]) == 1, done
    near(server.get(M + "/layers/steep/statistics").json()["area_m2"], total, 0.001)

    # only the expression can change a computed layer
    for method, path, body in (
        ("POST", "edits", {"op": "fill", "value": 1, "mode": "where", "where": "true"}),
        ("POST", "undo", None),
    ):
        answer = server.request(method, f"{M}/layers/risk/{path}", body)
        assert answer.status == 403 and answer.json()["title"] == "Layer is locked", answer

    # cycles, and expressions with unknown names
    for name, body in (
        ("risk", {"expression": "mask + 1"}),
        ("risk", {"expression": "risk + 1"}),
        ("mask", {"expression": "salt > 1"}),
        ("mask", {"expression": "risk >"}),
        ("mask", {"expression": "pieces.thick"}),
        ("pieces", {"expression": "1"}),
        ("wet", {"recompute": "automatic"}),
    ):
        answer = server.request("PATCH", f"{M}/layers/{name}", body)
        assert answer.status == 422 and answer.json()["field"] in ("expression", "recompute"), (
            body,
            answer,
        )
    before = server.get(M + "/layers").json()["total"]
    for body, field in (
        ({"expression": "wet + "}, "expression"),
        ({"expression": "x * 100", "type": "u8"}, "type"),
        ({"expression": "wet", "compute": {"kind": "slope"}}, "expression"),
        ({"expression": "wet", "kind": "database"}, "kind"),
        ({"recompute": "automatic"}, "recompute"),
    ):
        answer = server.post(M + "/layers", {"name": "Bad", "resolution": 2048, **body})
        assert answer.status == 422 and answer.json()["field"] == field, (body, answer)
    assert (
        server.get(M + "/layers").json()["total"] == before
    ), "nothing is left of a layer that cannot be computed"


def test_they_are_computed_anew_by_themselves(server):
    """An automatic layer can depend on another automatic layer."""
    for name in ("risk", "mask"):
        assert (
            server.ok("PATCH", f"{M}/layers/{name}", {"recompute": "automatic"}).json()["recompute"]
            == "automatic"
        )
    dab(server, "wet", 0.75, 30, 30, 4)
    wait_for(lambda: value(server, "mask", 30, 30).get("value") == 1, "the layers to follow")
    wait_for(
        lambda: not server.get(M + "/layers/mask").json()["stale"], "the layer to be up to date"
    )
    server.ok("PATCH", "/tables/pieces/records/1", {"values": {"state": "loose"}})
    wait_for(lambda: value(server, "risk", 30, 30)["value"] == 7.5, "a record to reach the surface")

    # without its expression the layer is an ordinary layer
    plain = server.ok("PATCH", M + "/layers/mask", {"expression": ""}).json()
    assert "expression" not in plain and value(server, "mask", 30, 30)["value"] == 1
    dab(server, "mask", 7, 30, 30, 3)
    assert value(server, "mask", 30, 30)["value"] == 7

    # the error contains the name of the deleted input
    compute(server, "Twice", "mask * 2")
    server.ok("DELETE", M + "/layers/mask")
    answer = server.post(M + "/layers/twice/compute")
    assert answer.status == 409 and "'mask', which was deleted" in answer.json()["detail"], answer
    assert server.get(M + "/layers/twice").json()["stale"] is True


def test_transfer(server):
    """The values are transferred to another scan, even without the inputs."""
    server.import_model(folded_grid(fold=0.001), "again.ply", name="Again", unit="mm")
    job = server.wait_for_job(
        server.ok(
            "POST",
            "/models/again/transfer",
            {"from": "sheet", "layers": ["risk"], "tolerance_mm": 1},
        ).json()["id"]
    )
    assert job["state"] == "done", job
    path = f"/models/again/layers/{job['layers'][0]}"
    assert "expression" not in server.get(path).json()
    there, here = (server.get(each + "/statistics").json() for each in (M + "/layers/risk", path))
    near(here["area_m2"], there["area_m2"], 0.02)
    assert here["max"] == there["max"], (here, there)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
