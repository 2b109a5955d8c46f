"""What became of the classes of a layer between two surveys of a flat sheet, over HTTP."""
import csv
import io
import math

import pytest
from support.meshes import folded_grid
from support.project_sites import Someone
from support.readings import dab

NOW, THEN = "/models/now", "/models/then"
CRACKS = NOW + "/layers/cracks"


def disc_m2(radius_mm):
    return math.pi * radius_mm**2 / 1e6


def run(server, body, path=CRACKS, **more):
    started = server.ok("POST", path + "/changes", body, expect=(202,), **more)
    job = server.wait_for_job(started.json()["id"])
    assert job["state"] == "done", job
    return job["changes"]


def near(value, expected):
    return abs(value / expected - 1) < 0.05


@pytest.fixture(scope="module")
def server(server):
    for model, name in ((THEN, "Then"), (NOW, "Now")):
        server.import_model(
            folded_grid(fold=0.001), "sheet.ply", name=name, unit="mm", resolution=2048
        )
        for layer in ("Cracks", "Salts"):
            server.ok(
                "POST",
                model + "/layers",
                {"name": layer, "type": "u8", "resolution": 2048},
            )
        server.ok("POST", model + "/layers", {"name": "Depth", "type": "f32", "resolution": 2048})
    # class 1 becomes class 2 in its middle, a piece vanishes, and another one appears
    dab(server, THEN + "/layers/cracks", 1, 30, 30, 15)
    dab(server, CRACKS, 1, 30, 30, 15)
    dab(server, CRACKS, 2, 30, 30, 5)
    dab(server, THEN + "/layers/cracks", 3, 75, 75, 8)
    dab(server, CRACKS, 1, 75, 25, 10)
    dab(server, CRACKS, 1, 20, 80, 1)
    return server


def test_each_class_has_an_area_that_became_each_class(server):
    changes = run(server, {"since": "then", "tolerance_mm": 1})
    assert changes["since"] == server.get(THEN).json()["id"]
    assert changes["layer"] == server.get(THEN + "/layers/cracks").json()["id"]
    assert near(changes["matched_m2"], changes["area_m2"]), changes
    table = changes["table"]
    assert table["rows"] == [1, 3, None] and table["columns"] == [1, 2, None], table
    stayed, became, cleaned = table["area_m2"][0]
    assert near(stayed, disc_m2(15) - disc_m2(5)) and near(became, disc_m2(5)), table
    assert cleaned < 0.02 * stayed, table
    assert near(table["area_m2"][1][2], disc_m2(8)) and table["area_m2"][1][0] == 0, table
    assert near(table["area_m2"][2][0], disc_m2(10) + disc_m2(1)), table
    assert changes["unmatched_now"] == [] and changes["unmatched_then"] == [], changes


def test_pieces_that_appeared_and_vanished_have_an_area_and_a_place(server):
    changes = run(server, {"since": "then", "tolerance_mm": 1, "min_area_cm2": 0.5})
    (new,) = changes["appeared"]["pieces"]
    assert changes["appeared"]["total"] == 1 and new["value"] == 1, changes["appeared"]
    assert near(new["area_m2"], disc_m2(10)) and math.dist(new["at"][:2], (75, 25)) < 1, new
    (gone,) = changes["vanished"]["pieces"]
    assert gone["value"] == 3 and near(gone["area_m2"], disc_m2(8)), gone
    assert math.dist(gone["at"][:2], (75, 75)) < 1, gone
    small = run(server, {"since": "then", "tolerance_mm": 1})
    assert small["appeared"]["total"] == 2, small["appeared"]


def test_the_table_is_also_a_file_with_names_and_sums(server):
    body = {"since": "then", "tolerance_mm": 1}
    started = server.ok("POST", CRACKS + "/changes?f=csv&separator=comma", body, expect=(202,))
    job = server.wait_for_job(started.json()["id"])
    assert job["state"] == "done" and job["file"]["name"] == "cracks-changes.csv", job
    text = server.get(f"/jobs/{job['id']}/file").body.decode("utf-8-sig")
    head, *rows = csv.reader(io.StringIO(text))
    assert head[1:] == ["1", "2", "not painted", "no counterpart", "total"], head
    assert [row[0] for row in rows] == ["1", "3", "not painted", "no counterpart", "total"], rows
    assert near(float(rows[0][2]), disc_m2(5) * 1e4), "the sheet is small, so areas are in cm²"
    refused = server.post(CRACKS + "/changes?f=pdf", body)
    assert refused.status == 406 and refused.json()["field"] == "f", refused


def test_another_layer_can_be_named(server):
    dab(server, THEN + "/layers/salts", 9, 30, 30, 15)
    changes = run(server, {"since": "then", "layer": "salts", "tolerance_mm": 1})
    assert changes["table"]["rows"] == [9, None], changes["table"]


def import_sheet(server, name, size, unit, **more):
    model = server.import_model(
        folded_grid(size=size, fold=0.001),
        "sheet.ply",
        name=name,
        unit=unit,
        resolution=2048,
        **more,
    )
    path = f"/models/{model['slug']}"
    server.ok("POST", path + "/layers", {"name": "Cracks", "type": "u8", "resolution": 2048})
    return path + "/layers/cracks"


def test_each_model_can_have_its_own_unit(server):
    # The same sheet of 100 mm. The coordinates of the readings are those of the model.
    dab(server, import_sheet(server, "In cm", 10, "cm"), 4, 5, 8.5, 6)
    changes = run(server, {"since": "in-cm", "tolerance_mm": 1})
    assert near(changes["matched_m2"], 0.01) and near(changes["area_m2"], 0.01), changes
    table = changes["table"]
    assert table["rows"] == [4, None], table
    assert near(table["area_m2"][0][-1], disc_m2(6)), table
    (gone,) = changes["vanished"]["pieces"]
    assert gone["value"] == 4 and near(gone["area_m2"], disc_m2(6)), gone
    assert math.dist(gone["at"][:2], (50, 85)) < 1, "in the unit of the open model"


def test_surfaces_without_a_counterpart_are_listed(server):
    # The sheet of 1 m extends beyond this sheet.
    large = import_sheet(server, "Large", 100, "cm")
    dab(server, large, 5, 75, 75, 50)
    changes = run(server, {"since": "large", "tolerance_mm": 1})
    (lost,) = changes["unmatched_then"]
    assert lost["value"] == 5 and near(lost["area_m2"], disc_m2(50)), lost
    assert changes["unmatched_now"] == [], changes
    assert changes["vanished"]["total"] == 0, "no surface of this model is there"
    # seen from the large sheet, whose unit is another one
    changes = run(server, {"since": "now", "tolerance_mm": 1}, path=large)
    (new,) = changes["unmatched_now"]
    assert new["value"] == 5 and near(new["area_m2"], disc_m2(50)), new
    assert near(changes["matched_m2"], 0.01) and near(changes["area_m2"], 1), changes
    assert changes["appeared"]["total"] == 0 and changes["unmatched_then"] == [], changes
    (disc,) = (p for p in changes["vanished"]["pieces"] if near(p["area_m2"], disc_m2(10)))
    assert math.dist(disc["at"][:2], (7.5, 2.5)) < 0.1, "in cm"


def test_refusals(server):
    cases = [
        ({"tolerance_mm": 1}, "since"),
        ({"since": "then"}, "tolerance_mm"),
        ({"since": "then", "tolerance_mm": 0}, "tolerance_mm"),
        ({"since": "then", "tolerance_mm": 1, "max_angle": 0}, "max_angle"),
        ({"since": "nothing", "tolerance_mm": 1}, "since"),
        ({"since": "now", "tolerance_mm": 1}, "since"),
        ({"since": "then", "layer": "nothing", "tolerance_mm": 1}, "layer"),
        ({"since": "then", "layer": "depth", "tolerance_mm": 1}, "layer"),
    ]
    for body, field in cases:
        answer = server.post(CRACKS + "/changes", body)
        assert answer.status == 422 and answer.json()["field"] == field, (body, answer)
    answer = server.post(NOW + "/layers/depth/changes", {"since": "then", "tolerance_mm": 1})
    assert answer.status == 422, answer
    # The number of values is known only after the layers are read.
    many = {"name": "Many", "type": "u16", "resolution": 2048, "expression": "x * 20"}
    server.ok("POST", NOW + "/layers", many)
    for path, body in (
        (NOW + "/layers/many", {"since": "then", "layer": "cracks", "tolerance_mm": 1}),
        (THEN + "/layers/cracks", {"since": "now", "layer": "many", "tolerance_mm": 1}),
    ):
        job = server.wait_for_job(server.post(path + "/changes", body).json()["id"])
        assert job["problem"]["title"] == "Too many values", job
        assert job["problem"]["field"] == "layer", job
    viewer = server.add_person("vera", "viewer")
    answer = server.request(
        "POST", CRACKS + "/changes", {"since": "then", "tolerance_mm": 1}, token=viewer
    )
    assert answer.status == 403, answer


def test_another_project_and_hidden_layers_cannot_be_compared(server):
    server.ok("POST", "/projects", {"name": "Elsewhere"})
    import_sheet(server, "Foreign", 100, "mm", project="elsewhere")
    refused = server.post(CRACKS + "/changes", {"since": "foreign", "tolerance_mm": 1})
    assert refused.status == 422 and refused.json()["title"] == "Different projects", refused
    layer = {"name": "Hidden", "type": "u8", "resolution": 2048}
    server.ok("POST", THEN + "/layers", layer)
    server.ok("PATCH", THEN + "/layers/hidden", {"visibility": "private"})
    ann = Someone(server, "ann", "guest")
    ann.now("default", "annotator")

    def refusal(body):
        answer = ann.request("POST", CRACKS + "/changes", {"tolerance_mm": 1, **body})
        assert answer.status == 422, answer
        return answer.json()

    # What an annotator cannot see does not exist for them.
    for hidden, absent in (
        ({"since": "foreign"}, {"since": "nothing"}),
        ({"since": "then", "layer": "hidden"}, {"since": "then", "layer": "nothing"}),
    ):
        told, expected = refusal(hidden), refusal(absent)
        assert told["title"] == expected["title"] and told["field"] == expected["field"], told
    run(server, {"since": "then", "layer": "hidden", "tolerance_mm": 1})


def test_a_repeated_call_finds_its_job(server):
    key = {"Idempotency-Key": "changes once"}
    body = {"since": "then", "tolerance_mm": 1}
    first = server.ok("POST", CRACKS + "/changes", body, expect=(202,), headers=key).json()["id"]
    again = server.ok("POST", CRACKS + "/changes", body, expect=(202,), headers=key).json()["id"]
    assert again == first


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
