"""Statistics of a layer in all surveys of an object over HTTP: three surveys of a flat sheet, one
whose layer is hidden from viewers, and one without the layer."""
import csv
import io
import math

import pytest
from support.addresses import query
from support.meshes import folded_grid
from support.readings import dab
from support.workbook import Workbook

OBJECTS = "/projects/default/objects"
DATES = {"then": "2019-05-01", "between": "2022-06", "now": "2025"}
CLASSES = {1: "Crack", 2: "Loss"}
CLASSES_OF_OTHERS = {4: "Crack", 5: "Salt"}


def disc_m2(radius_mm):
    return math.pi * radius_mm**2 / 1e6


def near(value, expected):
    return abs(value / expected - 1) < 0.05


def palette(labels):
    return {
        "mode": "categorical",
        "points": [{"at": at, "color": "#d55e00", "label": label} for at, label in labels.items()],
    }


def layer(server, model, name, **more):
    body = {"name": name, "resolution": 2048, "type": "u8", **more}
    return (
        f"/models/{model}/layers/"
        + server.ok("POST", f"/models/{model}/layers", body).json()["slug"]
    )


@pytest.fixture(scope="module")
def server(server):
    for model, date in DATES.items():
        server.import_model(
            folded_grid(fold=0.001),
            "sheet.ply",
            name=model.title(),
            unit="mm",
            resolution=2048,
            object="Bust",
            survey_date=date,
        )
    then = layer(server, "then", "Cracks", palette=palette(CLASSES))
    dab(server, then, 1, 30, 30, 10)
    dab(server, then, 2, 70, 70, 5)
    between = layer(
        server,
        "between",
        "Cracks",
        palette=palette(CLASSES_OF_OTHERS),
        visibility="private",
    )
    dab(server, between, 4, 30, 30, 15)
    dab(server, between, 5, 70, 70, 5)
    for model, wet in (("then", 0.25), ("now", 0.75)):
        moisture = layer(server, model, "Moisture", type="f32", unit="%")
        dab(server, moisture, wet, 50, 50, 20)
    layer(server, "now", "Salts")  # never painted
    layer(server, "now", "Secret", visibility="private")
    return server


@pytest.fixture(scope="module")
def bust(server):
    (found,) = server.get(OBJECTS).json()["objects"]
    return f"{OBJECTS}/{found['id']}/statistics"


@pytest.fixture(scope="module")
def vera(server):
    return server.add_person("vera", "viewer")


def surveys(server, path, **more):
    token = more.pop("token", True)
    answer = server.request("GET", query(path, **more), token=token)
    assert answer.status == 200, answer
    return answer.json()["surveys"]


def rows(server, path, **more):
    text = server.get(query(path, f="csv", **more)).body.decode("utf-8-sig")
    return list(csv.DictReader(io.StringIO(text, newline="")))


def test_surveys_have_the_statistics_of_their_layers_in_the_order_of_dates(server, bust):
    found = surveys(server, bust, layer="Cracks", include="pieces,perimeter")
    assert [each["date"] for each in found] == list(DATES.values())
    assert [each["slug"] for each in found] == list(DATES)
    for survey in found[:2]:
        of = survey["statistics"]
        alone = server.get(
            f"/models/{survey['slug']}/layers/cracks/statistics?include=pieces,perimeter"
        ).json()
        assert of["slug"] == "cracks" and of["unit"] == "" and of["sequence"] > 0, of
        for name in ("texels", "area_m2", "pieces", "perimeter_m"):
            assert of[name] == alone[name], (name, of, alone)
        assert near(of["share"], of["area_m2"] / 0.01), "the sheet has an area of 0.01 m²"
        assert "mean" not in of, "the mean of keys has no meaning"
        for a, b in zip(of["classes"], alone["keys"]):
            assert [a[name] for name in ("key", "texels", "area_m2", "pieces")] == [
                b[name] for name in ("key", "texels", "area_m2", "pieces")
            ]
    assert found[2]["statistics"] is None


def test_classes_have_the_labels_of_the_layer_in_their_survey(server, bust):
    then, between, _ = surveys(server, bust, layer="Cracks")
    areas = [
        {each["class"]: each["area_m2"] for each in survey["statistics"]["classes"]}
        for survey in (then, between)
    ]
    assert near(areas[0]["Crack"], disc_m2(10)) and near(areas[0]["Loss"], disc_m2(5)), areas
    assert near(areas[1]["Crack"], disc_m2(15)) and near(areas[1]["Salt"], disc_m2(5)), areas
    assert [len(each) for each in areas] == [2, 2], areas


def test_values_have_a_mean_and_quantiles(server, bust):
    then, between, now = surveys(server, bust, layer="Moisture", include="quantiles")
    assert between["statistics"] is None
    for survey, wet in ((then, 0.25), (now, 0.75)):
        of = survey["statistics"]
        assert near(of["area_m2"], disc_m2(20)) and of["unit"] == "%", of
        for name in ("mean", "min", "max"):
            assert abs(of[name] - wet) < 1e-6, of
        assert set(of["quantiles"].values()) == {wet}, of
        assert "classes" not in of, of


def test_a_hidden_layer_looks_like_a_missing_one(server, bust, vera):
    then, between, now = surveys(server, bust, layer="Cracks", token=vera)
    assert near(then["statistics"]["classes"][0]["area_m2"], disc_m2(10)), then
    assert between["statistics"] is None and now["statistics"] is None
    assert set(between) == set(now), "a difference would show that the layer exists"
    refused = [
        server.request("GET", query(bust, layer=name), token=vera) for name in ("Secret", "Absent")
    ]
    for answer, name in zip(refused, ("Secret", "Absent")):
        assert answer.status == 422 and answer.json()["field"] == "layer", answer
        assert answer.json()["detail"].replace(name, "") == refused[0].json()["detail"].replace(
            "Secret", ""
        )


def test_a_layer_without_values_has_no_area(server, bust):
    *_, now = surveys(server, bust, layer="salts", include="pieces")
    assert now["statistics"]["texels"] == now["statistics"]["area_m2"] == 0, now
    assert now["statistics"]["pieces"] == 0 and "mean" not in now["statistics"], now


def test_a_slug_finds_the_layer_if_none_has_this_name(server, bust):
    assert surveys(server, bust, layer="cracks") == surveys(server, bust, layer="Cracks")
    dab(server, layer(server, "now", "cracks", slug="other"), 1, 50, 50, 5)
    found = surveys(server, bust, layer="cracks")
    assert [each["statistics"]["slug"] for each in found] == ["cracks", "cracks", "other"], found
    server.ok("DELETE", "/models/now/layers/other")


def test_sheets_have_a_row_for_each_survey_and_a_column_for_each_class(server, bust):
    answer = server.get(query(bust, layer="Cracks", f="csv"))
    assert answer.headers["Content-Disposition"].endswith("''cracks-surveys.csv"), answer.headers
    then, between, now = rows(server, bust, layer="Cracks")
    assert [each["date"] for each in (then, between, now)] == list(DATES.values())
    assert near(float(then["Crack area_m2"]), disc_m2(10)), then
    assert near(float(then["Crack area (cm²)"]), disc_m2(10) * 1e4), then
    assert near(float(between["Salt area_m2"]), disc_m2(5)), between
    assert float(between["Loss area_m2"]) == float(then["Salt area_m2"]) == 0
    assert near(float(then["percent_of_surface"]), (disc_m2(10) + disc_m2(5)) * 1e4), then
    assert {text for head, text in now.items() if head not in ("date", "model")} == {""}, now
    values = rows(server, bust, layer="Moisture", include="quantiles")
    assert float(values[0]["p50"]) == 0.25 and values[1]["mean"] == "", values
    book = Workbook(server.get(query(bust, layer="Cracks", f="xlsx")).body)
    assert [row[:2] for row in book.rows[1:]] == [
        [date, model] for model, date in DATES.items()
    ], book.rows
    assert book.filtered.endswith("4"), "no row of totals is left out"
    assert near(book.records[0]["Crack area_m2"], disc_m2(10)), book.records


@pytest.mark.parametrize(
    "first, last, expected",
    [
        ("2019", "2022", ["then", "between"]),
        ("2022-06-30", "", ["between", "now"]),
        ("", "2019-04", []),
        ("2025-03", "2025-04", ["now"]),
    ],
)
def test_a_period_selects_surveys(server, bust, first, last, expected):
    limits = {name: text for name, text in (("from", first), ("to", last)) if text}
    found = surveys(server, bust, layer="Moisture", **limits)
    assert [each["slug"] for each in found] == expected


@pytest.mark.parametrize(
    "asked, status, field",
    [
        ({}, 422, "layer"),
        ({"layer": ""}, 422, "layer"),
        ({"layer": "Cracks", "include": "median"}, 422, "include"),
        ({"layer": "Cracks", "from": "2019-13"}, 422, "from"),
        ({"layer": "Cracks", "to": "May"}, 422, "to"),
        ({"layer": "Cracks", "f": "pdf"}, 406, "f"),
        ({"layer": "Cracks", "f": "csv", "separator": "x"}, 422, "separator"),
    ],
)
def test_a_bad_request_is_refused(server, bust, asked, status, field):
    answer = server.get(query(bust, **asked))
    assert answer.status == status and answer.json()["field"] == field, answer


def test_a_guest_of_another_project_sees_nothing(server, bust):
    server.ok("POST", "/projects", {"name": "Villa"})
    guest = server.add_person("gus", "guest")
    server.ok("PUT", "/projects/villa/members/gus", {"role": "curator"})
    for path in (bust, bust.replace("default", "villa")):
        assert server.request("GET", query(path, layer="Cracks"), token=guest).status == 404


def test_the_tag_changes_with_a_survey(server, bust):
    def tag():
        return server.get(query(bust, layer="Cracks")).headers["ETag"]

    before = tag()
    assert tag() == before
    path = query(bust, layer="Cracks")
    assert server.get(path, headers={"If-None-Match": before}).status == 304
    dab(server, "/models/between/layers/cracks", 4, 60, 30, 3)
    painted = tag()
    assert painted != before
    server.ok("PATCH", "/models/now", {"object": 0})
    assert tag() != painted
    assert [each["slug"] for each in surveys(server, bust, layer="Cracks")] == ["then", "between"]
