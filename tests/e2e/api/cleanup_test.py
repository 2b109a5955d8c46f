"""Clean-up of the regions of a layer, and records of the pieces of a class, over HTTP."""
import math
import urllib.parse

import pytest
from support.meshes import folded_grid
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
DAMAGE = M + "/layers/damage"


def area_cm2(server, layer, value):
    keys = server.get(f"{M}/layers/{layer}/statistics").json()["keys"]
    return 1e4 * sum(key["area_m2"] for key in keys if key["key"] == value)


def value_at(server, layer, x, y):
    point = urllib.parse.urlencode({"coords": f"POINT Z({x} {y} 0)", "parameter-name": layer})
    found = server.get(f"{M}/position?{point}").json()["values"][layer]
    return found.get("key", found.get("value")) if found["valid"] else None


def history(server, layer):
    return server.get(f"{M}/layers/{layer}/edits").json()


def run(server, path, body, **more):
    started = server.ok("POST", path, body, expect=(202,), **more)
    job = server.wait_for_job(started.json()["id"])
    assert job["state"] == "done", job
    return job["cleanup"]


def disc(radius_mm):
    return math.pi * radius_mm**2 / 100


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", M + "/layers", {"name": "Damage", "type": "u8", "resolution": 2048})
    server.ok("POST", M + "/layers", {"name": "Rims", "type": "u8", "resolution": 2048})
    columns = [
        {"name": "Number", "kind": "numeric"},
        {"name": "Area", "kind": "numeric", "unit": "cm²"},
        {"name": "Perimeter", "kind": "numeric", "unit": "mm"},
    ]
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Losses",
            "kind": "database",
            "type": "u8",
            "resolution": 2048,
            "columns": columns,
        },
    )
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Strict",
            "kind": "database",
            "type": "u8",
            "resolution": 2048,
            "columns": [{"name": "Code", "required": True}],
        },
    )
    dab(server, f"{M}/layers/damage", 1, 30, 30, 15)
    dab(server, f"{M}/layers/damage", 2, 30, 30, 1)  # a speck on the large area
    dab(server, f"{M}/layers/damage", 3, 70, 70, 1)  # a speck on nothing
    dab(server, f"{M}/layers/damage", 1, 75, 30, 10)
    return server


def test_a_preview_counts_and_changes_nothing(server):
    before = history(server, "damage")["total"]
    report = run(server, DAMAGE + "/cleanup", {"operation": "sieve", "area_cm2": 1, "apply": False})
    assert report["operation"] == "sieve" and not report["applied"] and report["regions"] == 2
    assert abs(report["area_m2"] * 1e4 / (2 * disc(1)) - 1) < 0.1, report
    assert "sequence" not in report and history(server, "damage")["total"] == before
    assert value_at(server, "damage", 30, 30) == 2


def test_small_regions_vanish_in_one_edit_that_can_be_undone(server):
    before = history(server, "damage")["total"]
    report = run(server, DAMAGE + "/cleanup", {"operation": "sieve", "area_cm2": 1})
    assert report["applied"] and report["regions"] == 2 and report["skipped_texels"] == 0
    assert value_at(server, "damage", 30, 30) == 1 and value_at(server, "damage", 70, 70) is None
    newest = history(server, "damage")["edits"][0]
    assert newest["op"] == "cleanup" and newest["sequence"] == report["sequence"]
    assert newest["texels_changed"] == report["texels"]
    assert history(server, "damage")["total"] == before + 1
    server.ok("POST", DAMAGE + "/undo")
    assert value_at(server, "damage", 30, 30) == 2 and value_at(server, "damage", 70, 70) == 3
    # nothing to change is no edit
    report = run(server, DAMAGE + "/cleanup", {"operation": "sieve", "area_cm2": 1e-6})
    assert not report["applied"] and report["texels"] == 0


def test_small_regions_can_become_unpainted(server):
    run(
        server,
        DAMAGE + "/cleanup",
        {"operation": "sieve", "area_cm2": 1, "erase_regions": True},
    )
    assert value_at(server, "damage", 30, 30) is None and value_at(server, "damage", 70, 70) is None
    full = disc(15) + disc(10)
    assert abs(area_cm2(server, "damage", 1) / (full - disc(1)) - 1) < 0.02
    # the hole that remains is filled
    report = run(server, DAMAGE + "/cleanup", {"operation": "fill-holes", "area_cm2": 1})
    assert report["regions"] == 1 and value_at(server, "damage", 30, 30) == 1
    assert abs(area_cm2(server, "damage", 1) / full - 1) < 0.02


def test_a_repeated_call_is_one_edit(server):
    before = history(server, "damage")["total"]
    key = {"Idempotency-Key": "clean once"}
    body = {"operation": "border", "width_mm": 1, "value": 9}
    first = server.ok("POST", DAMAGE + "/cleanup", body, headers=key).json()["id"]
    again = server.ok("POST", DAMAGE + "/cleanup", body, headers=key)
    assert again.json()["id"] == first and again.headers["Idempotency-Replayed"] == "true"
    job = server.wait_for_job(first)
    assert job["state"] == "done" and job["cleanup"]["applied"], job
    other = server.request("POST", DAMAGE + "/cleanup", {**body, "width_mm": 2}, headers=key)
    assert other.status == 422 and other.json()["field"] == "Idempotency-Key", other
    assert history(server, "damage")["total"] == before + 1
    server.ok("POST", DAMAGE + "/undo")


def test_a_border_is_painted_into_another_layer(server):
    body = {
        "operation": "border",
        "from": "damage",
        "of": 1,
        "width_mm": 2,
        "value": 7,
    }
    report = run(server, M + "/layers/rims/cleanup", body)
    # two rings, 2 mm wide
    expected = 2 * math.pi * (15 + 10) * 2 / 100
    assert abs(report["area_m2"] * 1e4 / expected - 1) < 0.05, report
    assert value_at(server, "rims", 45, 30) == 7 and value_at(server, "rims", 30, 30) is None


def test_narrow_parts_disappear_and_narrow_gaps_close(server):
    server.ok("POST", M + "/layers", {"name": "Stains", "type": "u8", "resolution": 2048})
    path = M + "/layers/stains"
    dab(server, path, 1, 30, 30, 15)
    dab(server, path, 1, 60, 30, 14)  # a gap of 1 mm to the first one
    dab(server, path, 1, 30, 70, 1)  # narrower than 3 mm
    run(server, path + "/cleanup", {"operation": "close", "width_mm": 3})
    assert value_at(server, "stains", 45.5, 30) == 1
    assert value_at(server, "stains", 45.5, 42) is None
    run(server, path + "/cleanup", {"operation": "open", "of": 1, "width_mm": 3})
    assert value_at(server, "stains", 30, 70) is None
    assert abs(area_cm2(server, "stains", 1) / (disc(15) + disc(14)) - 1) < 0.03
    # With several values, the request must name one.
    dab(server, path, 2, 80, 80, 5)
    body = {"operation": "open", "width_mm": 3}
    job = server.wait_for_job(server.ok("POST", path + "/cleanup", body).json()["id"])
    assert job["state"] == "failed" and job["problem"]["field"] == "of", job


def test_what_does_not_fit_is_refused(server):
    for path, body, field in (
        ("damage", {"operation": "sieve"}, "area_cm2"),
        ("damage", {"operation": "majority"}, "radius_mm"),
        ("damage", {"operation": "open", "of": 1}, "width_mm"),
        ("damage", {"operation": "close", "of": 1.5, "width_mm": 1}, "of"),
        ("damage", {"operation": "border", "value": 1}, "width_mm"),
        ("damage", {"operation": "border", "width_mm": 1}, "value"),
        ("damage", {"operation": "border", "width_mm": 1, "value": 300}, "value"),
        ("damage", {"operation": "border", "width_mm": 1, "value": 1, "of": 1.5}, "of"),
        ("damage", {"operation": "border", "width_mm": 1, "value": 1, "from": "none"}, "from"),
        ("losses", {"operation": "border", "width_mm": 1, "value": 99}, "value"),
        # members of other operations
        ("damage", {"operation": "sieve", "area_cm2": 2, "radius_mm": 5}, "radius_mm"),
        ("damage", {"operation": "majority", "radius_mm": 1, "area_cm2": 2}, "area_cm2"),
        (
            "damage",
            {"operation": "fill-holes", "area_cm2": 2, "erase_regions": True},
            "erase_regions",
        ),
        ("damage", {"operation": "border", "width_mm": 1, "value": 1, "inside": True}, "inside"),
        ("damage", {"operation": "border", "width_mm": 1, "value": 1, "erase": True}, "value"),
    ):
        refused = server.post(f"{M}/layers/{path}/cleanup", body)
        assert refused.json()["field"] == field, (body, refused.json())
        assert refused.status in (404, 422), refused
    refused = server.post(DAMAGE + "/cleanup", {"operation": "majority", "radius_mm": 90})
    assert refused.status == 422 and refused.json()["field"] == "radius_mm", refused
    assert "40 texels" in refused.json()["detail"], refused.json()
    # The stated radius is allowed.
    most = float(refused.json()["detail"].split("at most ")[1].split(" ")[0])
    body = {"operation": "majority", "radius_mm": most, "apply": False}
    run(server, DAMAGE + "/cleanup", body)


def test_roles_and_locks_apply(server):
    viewer = server.add_person("vera", "viewer")
    annotator = server.add_person("anna", "annotator")
    body = {"operation": "majority", "radius_mm": 1}
    pieces = {"into": "losses", "of": 1}
    for path, request in (("/cleanup", body), ("/piece-records", {**pieces, "apply": False})):
        assert server.request("POST", DAMAGE + path, request, token=viewer).status == 403
        run(server, DAMAGE + path, request, token=annotator)
    server.ok("PATCH", DAMAGE, {"locked": True})
    refused = server.request("POST", DAMAGE + "/cleanup", body, token=annotator)
    assert refused.status == 403 and refused.json()["title"] == "Layer is locked", refused
    # A preview changes nothing, so it is allowed.
    run(server, DAMAGE + "/cleanup", {**body, "apply": False}, token=annotator)
    server.ok("PATCH", DAMAGE, {"locked": False})
    server.ok("PATCH", M + "/layers/losses", {"locked": True})
    refused = server.request("POST", DAMAGE + "/piece-records", pieces, token=annotator)
    assert refused.status == 403, refused
    run(server, DAMAGE + "/piece-records", {**pieces, "apply": False}, token=annotator)
    server.ok("PATCH", M + "/layers/losses", {"locked": False})
    # Layers that an annotator cannot see do not exist for them.
    server.ok("PATCH", M + "/layers/rims", {"visibility": "private"})
    hidden = {"operation": "border", "from": "rims", "width_mm": 1, "value": 1}
    assert server.request("POST", DAMAGE + "/cleanup", hidden, token=annotator).status == 404
    job = server.wait_for_job(server.post(DAMAGE + "/cleanup", hidden).json()["id"])
    assert job["problem"]["field"] == "from", job


def test_each_piece_becomes_a_record(server):
    path = DAMAGE + "/piece-records"
    body = {
        "into": "losses",
        "of": 1,
        "min_area_cm2": 1,
        "number_column": "number",
        "area_column": "area",
        "perimeter_column": "perimeter",
    }
    assert run(server, path, {**body, "apply": False})["regions"] == 2
    assert server.get("/tables/losses/records").json()["total"] == 0
    report = run(server, path, body)
    assert report["applied"] and report["regions"] == 2 and len(report["keys"]) == 2
    for key, number, radius in zip(report["keys"], (1, 2), (15, 10)):
        values = server.get(f"/tables/losses/records/{key}").json()["values"]
        assert values["number"] == number
        assert abs(values["area"] / disc(radius) - 1) < 0.02, values
        assert abs(values["perimeter"] / (2 * math.pi * radius) - 1) < 0.03, values
    assert value_at(server, "losses", 30, 30) == report["keys"][0]
    assert value_at(server, "losses", 75, 30) == report["keys"][1]


def test_pieces_are_numbered_in_reading_order_on_request(server):
    """Three stones: the largest one is at the bottom, and the smallest one at the top left."""
    stones = (
        "case when y > 70 and x < 20 then 1 when y > 70 and x > 60 and x < 90 then 2 "
        "when y < 50 then 3 end"
    )
    body = {"name": "Stones", "expression": stones, "resolution": 2048, "type": "u8"}
    server.ok("POST", M + "/layers", body)
    columns = [{"name": "Number", "kind": "integer"}]
    body = {"name": "Blocks", "kind": "database", "type": "u8", "resolution": 2048}
    server.ok("POST", M + "/layers", {**body, "columns": columns})
    path, body = M + "/layers/stones/piece-records", {"into": "blocks", "number_column": "number"}
    for wish, numbers in (({}, [3, 2, 1]), ({"in_reading_order": True}, [1, 2, 3])):
        run(server, path, {**body, **wish})
        keys = [int(value_at(server, "blocks", x, y)) for x, y in ((10, 80), (75, 80), (50, 20))]
        found = [server.get(f"/tables/blocks/records/{key}").json()["values"] for key in keys]
        assert [values["number"] for values in found] == numbers, wish


def test_cracks_become_records_with_length_and_width_in_reading_order(server):
    lines = (
        "(y between 79.8 and 80.2 and x between 20 and 80) or "
        "(x between 69.7 and 70.3 and y between 10 and 50) or "
        "(x between 19.9 and 20.1 and y between 10 and 40) or "
        "(y between 24.9 and 25.1 and x between 20 and 35)"
    )
    body = {"name": "Cracks", "expression": lines, "resolution": 2048, "type": "u8"}
    server.ok("POST", M + "/layers", body)
    columns = [
        {"name": name, "kind": "numeric"} for name in ("Number", "Length", "Width", "Greatest")
    ]
    body = {"name": "Found", "kind": "database", "type": "u8", "resolution": 2048}
    server.ok("POST", M + "/layers", {**body, "columns": columns})
    path = M + "/layers/cracks/piece-records"
    body = {
        "into": "found",
        "as_lines": True,
        "number_column": "number",
        "length_column": "length",
        "width_column": "width",
        "greatest_width_column": "greatest",
    }
    assert run(server, path, {**body, "apply": False})["regions"] == 3
    report = run(server, path, body)
    assert report["applied"] and len(report["keys"]) == 3, report
    # the second one has a branch
    for key, number, length, width in zip(report["keys"], (1, 2, 3), (60, 45, 40), (0.4, 0.2, 0.6)):
        values = server.get(f"/tables/found/records/{key}").json()["values"]
        assert values["number"] == number, values
        assert abs(values["length"] / length - 1) < 0.05, values
        assert abs(values["width"] / width - 1) < 0.1, values
        assert abs(values["greatest"] - width) < 0.16, values
    assert value_at(server, "found", 70, 30) == report["keys"][2]
    refused = server.post(path, {**body, "as_lines": False})
    assert refused.status == 422 and refused.json()["field"] == "length_column", refused
    refused = server.post(path, {**body, "width_column": "none"})
    assert refused.status == 422 and refused.json()["field"] == "width_column", refused


def test_if_a_record_cannot_be_written_nothing_is_painted(server):
    path = DAMAGE + "/piece-records"
    job = server.wait_for_job(server.ok("POST", path, {"into": "strict"}).json()["id"])
    assert job["state"] == "failed" and job["problem"]["status"] == 422, job
    assert "nothing was changed" in job["problem"]["detail"], job
    assert history(server, "strict")["total"] == 0
    assert server.get("/tables/strict/records").json()["total"] == 0
    assert server.post(path, {"into": "rims"}).json()["field"] == "into"
    refused = server.post(path, {"into": "losses", "area_column": "none"})
    assert refused.status == 422 and refused.json()["field"] == "area_column", refused


def test_after_a_restart_repeated_calls_get_the_first_result(server):
    """The result comes from the history. Nothing is painted and no record is created again, even if
    the layer has been locked since."""
    annotator = server.add_person("arno", "annotator")
    calls = (
        ("/piece-records", {"into": "losses", "of": 1, "min_area_cm2": 1}, {"of": 2}),
        ("/cleanup", {"operation": "border", "of": 1, "width_mm": 1, "value": 9}, {"value": 8}),
    )

    def send(path, body):
        key = {"Idempotency-Key": "before the restart"}
        return server.request("POST", DAMAGE + path, body, headers=key, token=annotator)

    def state():
        records = server.get("/tables/losses/records").json()["total"]
        return records, history(server, "damage")["total"], history(server, "losses")["total"]

    first = [server.wait_for_job(send(path, body).json()["id"]) for path, body, _ in calls]
    assert all(job["cleanup"]["applied"] for job in first), first
    assert len(first[0]["cleanup"]["keys"]) == 2, first
    for layer in ("damage", "losses"):
        server.ok("PATCH", f"{M}/layers/{layer}", {"locked": True})
    before = state()
    server.kill()
    server.start()
    for (path, body, other), earlier in zip(calls, first):
        refused = send(path, {**body, **other})
        assert refused.status == 422 and refused.json()["field"] == "Idempotency-Key", refused
        again = send(path, body)
        assert again.status == 202 and again.headers["Idempotency-Replayed"] == "true", again
        job = server.wait_for_job(again.json()["id"])
        assert job["state"] == "done" and job["id"] != earlier["id"], job
        assert job["cleanup"] == earlier["cleanup"], (job, earlier)
        # the caller also sees the report
        own = server.request("GET", f"/jobs/{job['id']}", token=annotator).json()
        assert own["cleanup"] == job["cleanup"], own
        assert send(path, body).json()["id"] == job["id"]
    assert state() == before


def test_if_the_server_stops_during_a_job_no_record_without_texels_remains(server):
    def records():
        found = server.get("/tables/losses/records?limit=1000").json()
        return {record["key"] for record in found["records"]}

    server.ok("PATCH", M + "/layers/losses", {"locked": False})
    for _ in range(3):
        before = records()
        body = {"into": "losses", "of": 1, "min_area_cm2": 1}
        server.ok("POST", DAMAGE + "/piece-records", body, expect=(202,))
        assert server.stop() == 0
        server.start()
        new = records() - before
        keys = server.get(f"{M}/layers/losses/statistics").json()["keys"]
        assert new <= {key["key"] for key in keys}, (new, keys)
        assert len(new) in (0, 2), new


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
