"""Queries over HTTP: statistics with their parts, of earlier times and with a condition;
selections, cross-tables, refusals."""
import math
import urllib.parse

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm


def layer(server, name, kind="u8"):
    return (
        f"{M}/layers/"
        + server.ok("POST", M + "/layers", {"name": name, "type": kind, "resolution": 2048}).json()[
            "slug"
        ]
    )


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), (a, b)


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    layer(server, "Depth", "f32")
    return server


@pytest.fixture(scope="module")
def marks(server):
    return layer(server, "Marks")


@pytest.fixture(scope="module")
def risk(server):
    return layer(server, "Risk")


def test_statistics(server, marks):
    first = dab(server, marks, 3, 30, 30, 10)
    told = server.get(marks + "/edits").json()["edits"][0]["time"]
    dab(server, marks, 5, 70, 30, 5)
    dab(server, marks, 5, 70, 70, 5)
    now = server.get(marks + "/statistics?include=pieces,perimeter,quantiles").json()
    near(now["area_m2"], 150 * math.pi * 1e-6, 0.02)
    assert now["pieces"] == 3 and {k["key"]: k["pieces"] for k in now["keys"]} == {3: 1, 5: 2}, now
    near(now["perimeter_m"], (20 + 10 + 10) * math.pi * 1e-3, 0.02)
    for key, around in {3: 20 * math.pi * 1e-3, 5: 20 * math.pi * 1e-3}.items():
        near({k["key"]: k["perimeter_m"] for k in now["keys"]}[key], around, 0.02)
    assert (now["quantiles"]["p5"], now["quantiles"]["p50"], now["quantiles"]["p95"]) == (
        3,
        3,
        5,
    ), now["quantiles"]
    assert "pieces" not in server.get(marks + "/statistics").json()

    for at in (first["sequence"], told):
        past = server.get(marks + "/statistics?" + urllib.parse.urlencode({"at": at}))
        assert past.headers["Strata-Sequence"] == str(first["sequence"]), (at, past.headers)
        assert [k["key"] for k in past.json()["keys"]] == [3], (at, past.json())
    assert server.get(marks + "/statistics?at=1970-01-01").json()["texels"] == 0
    where = server.get(
        marks + "/statistics?" + urllib.parse.urlencode({"where": "marks = 5"})
    ).json()
    assert where["texels"] == {k["key"]: k["texels"] for k in now["keys"]}[5]
    for query, field in (
        ("at=99999", "at"),
        ("at=soon", "at"),
        ("at=2026-02-30T00:00:00Z", "at"),
        ("at=-1", "at"),
        ("include=all", "include"),
        ("where=salt%3E1", "where"),
        ("where=marks%3E", "where"),
    ):
        answer = server.get(f"{marks}/statistics?{query}")
        assert answer.status == 422 and answer.json()["field"] == field, (query, answer)

    point = "/position?" + urllib.parse.urlencode(
        {"coords": "POINT Z(70 30 0)", "parameter-name": "marks"}
    )
    assert server.get(M + point).json()["values"]["marks"] == {"valid": True, "value": 5}
    assert (
        server.get(f"{M}{point}&at={first['sequence']}").json()["values"]["marks"]["valid"] is False
    )
    asked = {"points": [[70, 30, 0]], "layers": ["marks"], "at": told}
    assert (
        server.ok("POST", M + "/positions", asked).json()["positions"][0]["values"]["marks"][
            "valid"
        ]
        is False
    )


def test_selections(server, marks, risk):
    body = {"where": "marks = 5", "layers": ["marks"], "include": ["pieces", "perimeter"]}
    selected = server.ok("POST", M + "/select", body).json()
    near(selected["area_m2"], 50 * math.pi * 1e-6, 0.03)
    near(selected["share"], selected["area_m2"] / server.get(M).json()["area_m2"], 1e-3)
    assert selected["layers"]["marks"]["pieces"] == 2, selected
    near(selected["layers"]["marks"]["perimeter_m"], 20 * math.pi * 1e-3, 0.02)
    assert selected["bounds"]["min"][0] > 60 and selected["bounds"]["max"][1] < 80, selected[
        "bounds"
    ]

    disc = server.ok(
        "POST", M + "/select", {"within": {"at": {"point": [50, 50, 0]}, "radius_mm": 12}}
    ).json()
    near(disc["area_m2"], 144 * math.pi * 1e-6, 0.02)
    half = server.ok(
        "POST",
        M + "/select",
        {
            "within": {"at": {"point": [30, 30, 0]}, "radius_mm": 5},
            "where": "marks = 3",
            "layers": ["marks"],
        },
    ).json()
    near(half["area_m2"], 25 * math.pi * 1e-6, 0.03)

    camera = camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))
    outline = {"camera": camera, "path": [[300, 200], [340, 200], [340, 280], [300, 280]]}
    inside = server.ok("POST", M + "/select", {"within": outline}).json()
    painted = server.ok("POST", risk + "/edits", {"op": "polygon", "value": 1, **outline}).json()
    assert inside["texels"] == painted["texels_changed"], (inside, painted)
    server.ok("POST", risk + "/undo")

    into = {"where": "marks = 5", "into": {"layer": "risk", "value": 2}}
    done = server.ok("POST", M + "/select", into, headers={"Idempotency-Key": "into-1"}).json()
    assert done["edit"]["texels_changed"] == done["texels"] > 0, done
    again = server.ok("POST", M + "/select", into, headers={"Idempotency-Key": "into-1"}).json()
    assert again["edit"]["sequence"] == done["edit"]["sequence"], (again, done)
    assert server.get(risk + "/statistics").json()["texels"] == done["texels"]
    for body, field in (
        ({"into": {"layer": "risk", "value": 2}}, "into"),
        ({"where": "true", "at": 1, "into": {"layer": "risk", "value": 2}}, "into"),
        ({"where": "true", "into": {"layer": "salt", "value": 2}}, "into.layer"),
        ({"where": "true", "into": {"layer": "risk", "value": 999}}, "value"),
        ({"layers": ["salt"]}, "layers"),
        ({"within": {"at": {"point": [0, 0, 0]}}}, "within"),
        (
            {"within": {"radius_mm": 3, "camera": camera, "path": [[0, 0], [1, 1], [2, 0]]}},
            "within",
        ),
    ):
        answer = server.post(M + "/select", body)
        assert answer.status in (404, 422) and answer.json()["field"].startswith(field), (
            body,
            answer,
        )


def test_cross_table(server, marks):
    units = layer(server, "Units", "u16")
    dab(server, units, 1000, 30, 30, 20)
    dab(server, units, 1001, 70, 30, 20)
    table = server.ok("POST", M + "/cross-table", {"rows": "units", "columns": "marks"}).json()
    assert (table["rows"], table["columns"]) == ([1000, 1001, None], [3, 5, None]), table
    area = table["area_m2"]
    near(area[0][0], 100 * math.pi * 1e-6, 0.03)
    near(area[1][1], 25 * math.pi * 1e-6, 0.03)
    near(sum(area[0]), 400 * math.pi * 1e-6, 0.02)
    assert area[0][1] == area[2][2] == 0 and area[2][1] > 0, table
    assert "agreement" not in table, "the layers contain measurements"
    csv = server.ok(
        "POST",
        M + "/cross-table",
        {"rows": "units", "columns": "marks"},
        headers={"Accept": "text/csv"},
    )
    lines = csv.body.decode().split("\r\n")
    assert (
        lines[0] == "units / marks,3,5,-" and lines[3].startswith("-,0,") and len(lines) == 5
    ), lines
    assert (
        server.post(M + "/cross-table", {"rows": "units", "columns": "depth"}).json()["field"]
        == "columns"
    )


def observer(server, name, labels):
    path = layer(server, name)
    points = [
        {"at": key, "color": "#d55e00", **({"label": label} if label else {})}
        for key, label in labels.items()
    ]
    server.ok("PATCH", path, {"palette": {"mode": "categorical", "points": points}})
    return path


def agreement_of(table, neither):
    """The reference: the formula of Cohen (1960), with areas in place of counts."""
    both, first, second = {None: neither}, {None: neither}, {None: neither}
    for row, areas in zip(table["rows"], table["area_m2"]):
        for column, area in zip(table["columns"], areas):
            first[row] = first.get(row, 0) + area
            second[column] = second.get(column, 0) + area
            if row == column:
                both[row] = both.get(row, 0) + area
    everything = sum(first.values())
    observed = sum(both.values()) / everything
    expected = sum(first[key] * second.get(key, 0) for key in first) / everything**2
    return observed, expected, (observed - expected) / (1 - expected)


def test_agreement_of_two_observers(server):
    anna = observer(server, "Anna", {1: "Crack", 2: "Loss"})
    bo = observer(server, "Bo", {1: "crack", 2: "", 3: "Salt"})
    dab(server, anna, 1, 30, 30, 20)
    dab(server, bo, 1, 40, 30, 20)
    dab(server, bo, 3, 80, 80, 10)
    both = {"rows": "anna", "columns": "bo"}
    table = server.ok("POST", M + "/cross-table", both).json()
    found = table["agreement"]
    surface = server.get(M).json()["area_m2"]
    near(found["area_m2"], surface, 0.01)
    painted = sum(map(sum, table["area_m2"]))
    observed, expected, kappa = agreement_of(table, found["area_m2"] - painted)
    assert abs(found["observed"] - observed) < 1e-9, found
    assert abs(found["expected"] - expected) < 1e-9, found
    assert abs(found["kappa"] - kappa) < 1e-9 and 0 < kappa < 1, found
    cracks, salt, unpainted = found["classes"]
    assert [each["key"] for each in found["classes"]] == [1, 3, None], found
    # two discs of 20 mm whose centers are 10 mm apart
    lens = 2 * 400 * math.acos(10 / 40) - 10 / 2 * math.sqrt(4 * 400 - 100)
    near(cracks["area_both_m2"], lens * 1e-6, 0.02)
    near(cracks["iou"], lens / (2 * 400 * math.pi - lens), 0.03)
    near(cracks["f1"], lens / (400 * math.pi), 0.03)
    assert salt["iou"] == salt["f1"] == salt["area_first_m2"] == 0, salt
    near(salt["area_second_m2"], 100 * math.pi * 1e-6, 0.03)
    near(unpainted["area_first_m2"], surface - 400 * math.pi * 1e-6, 0.01)
    near(found["observed_painted"], cracks["area_both_m2"] / painted, 1e-9)

    swapped = server.ok("POST", M + "/cross-table", {"rows": "bo", "columns": "anna"}).json()
    assert abs(swapped["agreement"]["kappa"] - kappa) < 1e-9, swapped
    same = server.ok("POST", M + "/cross-table", {"rows": "bo", "columns": "bo"}).json()
    assert same["agreement"]["kappa"] == same["agreement"]["observed"] == 1, same
    # in the middle of both discs, both layers have only cracks
    middle = {"within": {"at": {"point": [35, 30, 0]}, "radius_mm": 5}}
    one_class = server.ok("POST", M + "/cross-table", {**both, **middle}).json()["agreement"]
    assert (one_class["observed"], one_class["kappa"]) == (1, None), one_class
    csv = server.ok("POST", M + "/cross-table", both, headers={"Accept": "text/csv"})
    assert csv.body.decode().count("\r\n") == 1 + len(table["rows"]), "only the areas"

    renamed = {1: "Loss", 2: "Crack"}
    points = [{"at": key, "color": "#d55e00", "label": name} for key, name in renamed.items()]
    server.ok("PATCH", bo, {"palette": {"mode": "categorical", "points": points}})
    assert "agreement" not in server.ok("POST", M + "/cross-table", both).json()


def test_profile(server, marks):
    asked = {"places": [[10, 30, 5], [50, 30, 5]], "step_mm": 0.1, "layers": ["marks"]}
    profile = server.ok("POST", M + "/profile", asked).json()
    near(profile["length_mm"], 40, 0.01)
    inside = [
        s["along_mm"]
        for s in profile["samples"]
        if s["point"]["values"]["marks"] == {"valid": True, "value": 3}
    ]
    near(inside[0], 10, 0.02)
    near(inside[-1], 30, 0.02)
    lines = (
        server.ok("POST", M + "/profile", asked, headers={"Accept": "text/csv"})
        .body.decode()
        .split("\r\n")
    )
    assert (
        lines[0] == "along_mm,hit,x,y,z,normal_x,normal_y,normal_z,distance,u,v,marks"
        and len(lines) == 403
    ), lines[:2]
    camera = camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))
    seen = server.ok(
        "POST", M + "/profile", {"camera": camera, "path": [[0, 240], [639, 240]], "layers": []}
    ).json()
    near(seen["length_mm"], 100, 0.02)
    assert not seen["samples"][0]["point"]["hit"] and len(seen["samples"]) == 640
    for body, field in (
        ({"places": [[0, 0, 0], [50, 0, 0]], "step_mm": 1e-6}, "step_mm"),
        ({"places": [[0, 0, 0]], "step_mm": 1}, "places"),
        ({"places": [[0, 0, 0], [1, 0, 0]], "step_mm": 1, "layers": ["salt"]}, "layers"),
    ):
        answer = server.post(M + "/profile", body)
        assert answer.status in (404, 422) and answer.json()["field"].startswith(field), (
            body,
            answer,
        )


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
