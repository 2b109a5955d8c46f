"""Analyses over HTTP: several computed layers and statistics as one job, compared with the same
steps one by one."""
import math

import pytest
from support.meshes import folded_grid
from support.readings import dab
from support.strata_server import wait_for

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
NEAR = {"name": "Near cracks", "unit": "mm", "expression": "distance(cracks, 60)"}
RELIEF = {"name": "Relief", "compute": {"kind": "height"}}
DAMP = {"name": "Damp near cracks", "expression": "near-cracks < 20 and moisture > 0.5"}
CHAIN = [
    {"layer": NEAR},
    {"layer": RELIEF},
    {"layer": DAMP},
    {"statistics": {"layer": "damp-near-cracks", "include": ["pieces", "perimeter"]}},
    {"statistics": {"layer": "relief", "where": "valid(damp-near-cracks)"}},
]


def analyse(server, steps, name="Damp near cracks", model=M, **more):
    started = server.ok(
        "POST", model + "/analysis", {"name": name, "steps": steps}, expect=(202,), **more
    )
    assert started.headers["Location"] == f"/api/v1/jobs/{started.json()['id']}"
    return started.json()["id"]


def layers(server):
    return sorted(layer["slug"] for layer in server.get(M + "/layers").json()["layers"])


def statistics(server, layer, **query):
    asked = "&".join(f"{name}={value}" for name, value in query.items())
    return server.ok("GET", f"{M}/layers/{layer}/statistics?{asked}").json()


def trash(server):
    return server.ok("GET", "/projects/default/bin").json()["total"]


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    server.ok("POST", M + "/layers", {"name": "Moisture", "type": "f32"})
    dab(server, f"{M}/layers/cracks", 1, 30, 30, 5)
    dab(server, f"{M}/layers/moisture", 0.75, 40, 30, 20)
    dab(server, f"{M}/layers/moisture", 0.25, 80, 80, 10)
    return server


def test_a_chain_has_the_values_of_its_steps_one_by_one(server, story):
    job = server.wait_for_job(analyse(server, CHAIN))
    assert job["state"] == "done" and job["progress"] == 1, job
    report = story.report = job["analysis"]
    story.job = job["id"]
    assert report["name"] == "Damp near cracks" and len(report["steps"]) == 5, report
    near, relief, damp, pieces, heights = report["steps"]
    assert job["layers"] == [near["layer"], relief["layer"], damp["layer"]], job
    # What each step read.
    assert near["expression"] == "distance(cracks, 60)"
    assert [each["slug"] for each in near["inputs"]] == ["cracks"]
    assert relief["recipe"]["kind"] == "height" and "expression" not in relief
    assert relief["inputs"] == [] and "sequence" not in relief
    assert [each["slug"] for each in damp["inputs"]] == ["moisture", "near-cracks"]
    assert damp["inputs"][1]["layer"] == near["layer"]
    assert near["sequence"] < damp["sequence"] <= pieces["sequence"] <= heights["sequence"]
    assert heights["where"] == "valid(damp-near-cracks)"
    assert [each["slug"] for each in heights["inputs"]] == ["damp-near-cracks", "relief"]
    # The area is the part of the damp disc that is within 20 mm of the crack: two discs, whose
    # centers are 10 mm apart.
    r, far, d = 20, 25, 10
    lens = (
        r**2 * math.acos((d**2 + r**2 - far**2) / (2 * d * r))
        + far**2 * math.acos((d**2 + far**2 - r**2) / (2 * d * far))
        - 0.5 * math.sqrt((-d + r + far) * (d + r - far) * (d - r + far) * (d + r + far))
    )
    assert abs(pieces["statistics"]["area_m2"] / (lens * 1e-6) - 1) < 0.03, pieces
    # The same steps by hand have the same values.
    for body in (
        NEAR,
        RELIEF,
        {**DAMP, "expression": DAMP["expression"].replace("near-c", "by-hand-near-c")},
    ):
        made = server.ok("POST", M + "/layers", {**body, "name": "By hand " + body["name"].lower()})
        if made.status == 202:
            assert server.wait_for_job(made.json()["id"])["state"] == "done"
    for slug in ("near-cracks", "relief", "damp-near-cracks"):
        one, other = statistics(server, slug), statistics(server, "by-hand-" + slug)
        assert one == other and one["texels"] > 0, slug
    asked = {"include": "pieces,perimeter", "at": pieces["sequence"]}
    assert statistics(server, "damp-near-cracks", **asked) == pieces["statistics"]
    asked = {"where": "valid(by-hand-damp-near-cracks)"}
    by_hand = statistics(server, "by-hand-relief", **asked)
    assert by_hand["texels"] == heights["statistics"]["texels"] == pieces["statistics"]["texels"]
    assert math.isclose(by_hand["mean"], heights["statistics"]["mean"], rel_tol=1e-9)


def test_its_layers_name_the_analysis(server, story):
    of_analysis = {"name": "Damp near cracks", "of": 5, "job": story.job}
    for number, slug in ((1, "near-cracks"), (2, "relief"), (3, "damp-near-cracks")):
        layer = server.get(f"{M}/layers/{slug}").json()
        assert layer["analysis"] == {**of_analysis, "step": number}, layer
        assert layer["locked"] and not layer["visible"] and not layer.get("stale"), layer
        step = story.report["steps"][number - 1]
        assert layer.get("computed_sequence") == step.get("sequence"), layer
    assert "analysis" not in server.get(M + "/layers/by-hand-relief").json()
    path = M + "/layers/near-cracks"
    server.ok("PATCH", path, {"name": "Close to cracks"})
    assert server.get(path).json()["analysis"]["step"] == 1
    server.ok("PATCH", path, {"expression": "distance(cracks, 50)"})
    assert "analysis" not in server.get(path).json(), "other values come from another expression"
    assert story.job in [job["id"] for job in server.get("/jobs").json()["jobs"]]


def test_a_repeated_call_is_the_same_job(server):
    key = {"Idempotency-Key": "one analysis"}
    steps = [{"layer": {"name": "Repeated", "expression": "moisture * 2"}}]
    job = analyse(server, steps, headers=key)
    first = server.wait_for_job(job)
    assert first["state"] == "done"
    assert analyse(server, steps, headers=key) == job
    other = {"name": "Other", "steps": steps}
    assert server.post(M + "/analysis", other, headers=key).status == 422
    server.kill()
    server.start()
    again = server.wait_for_job(analyse(server, steps, headers=key))
    assert again["state"] == "done" and again["analysis"] == first["analysis"]
    assert again["layers"] == first["layers"] and layers(server).count("repeated") == 1
    # without the key, the slug is in use
    answer = server.post(M + "/analysis", {"name": "Again", "steps": steps})
    assert answer.status == 409 and answer.json()["field"] == "steps[0].layer.name", answer


def test_all_steps_are_checked_before_the_first(server):
    before, jobs = layers(server), server.get("/jobs").json()["total"]
    good = {"layer": {"name": "Good", "expression": "moisture * 2"}}
    on_good = lambda member, value: {"statistics": {"layer": "good", member: value}}
    for steps, field, status in (
        ([], "steps", 422),
        ([good] * 21, "steps", 422),
        ([good, {}], "steps[1].layer", 422),
        ([{**good, "statistics": {"layer": "cracks"}}], "steps[0].statistics", 422),
        ([{"layer": {**good["layer"], "expresion": "1"}}], "steps[0].layer.expresion", 422),
        ([{"layer": {"name": "Painted"}}], "steps[0].layer", 422),
        (
            [good, {"layer": {"name": "L", "expression": "godo + 1"}}],
            "steps[1].layer.expression",
            422,
        ),
        (
            [good, {"layer": {"name": "L", "expression": "good +"}}],
            "steps[1].layer.expression",
            422,
        ),
        (
            [{"layer": {"name": "L", "expression": "good + 1"}}, good],
            "steps[0].layer.expression",
            422,
        ),
        (
            [good, {"layer": {"name": "L", "expression": "focal_mean(good, 500)"}}],
            "steps[1].layer.expression",
            422,
        ),
        ([good, {"layer": {**good["layer"], "slug": "7"}}], "steps[1].layer.slug", 422),
        ([good, {"layer": {"name": "good", "expression": "1"}}], "steps[1].layer.name", 409),
        ([{"layer": {"name": "Cracks", "expression": "1"}}], "steps[0].layer.name", 409),
        (
            [{"layer": {"name": "L", "compute": {"kind": "height", "rays": 64}}}],
            "steps[0].layer.compute.rays",
            422,
        ),
        (
            [{"layer": {"name": "L", "compute": {"kind": "model_distance", "model": "no"}}}],
            "steps[0].layer.compute.model",
            422,
        ),
        ([good, {"statistics": {"layer": "better"}}], "steps[1].statistics.layer", 422),
        ([good, on_good("where", "goods > 1")], "steps[1].statistics.where", 422),
        ([good, on_good("where", "good >")], "steps[1].statistics.where", 422),
        ([good, on_good("include", ["mean"])], "steps[1].statistics.include[0]", 422),
        ([{"statistics": {"layer": "cracks"}}], "steps", 422),
        # everyone would see what only curators may see
        (
            [
                {"layer": {**good["layer"], "visibility": "private"}},
                {"layer": {"name": "L", "expression": "good + 1"}},
            ],
            "steps[1].layer.expression",
            422,
        ),
    ):
        answer = server.post(M + "/analysis", {"name": "Refused", "steps": steps})
        assert (answer.status, answer.json().get("field")) == (status, field), (steps, answer)
    mistake = server.post(
        M + "/analysis",
        {"name": "Refused", "steps": [good, {"layer": {"name": "L", "expression": "1 + godo"}}]},
    ).json()
    assert (mistake["offset"], mistake["suggestions"]) == (4, ["good"]), mistake
    for body in ({"steps": [good]}, {"name": "", "steps": [good]}, {"name": "N", "step": [good]}):
        assert server.post(M + "/analysis", body).status == 422, body
    assert server.post(M + "/analysis", "{").status == 400
    assert server.post("/models/no-such/analysis", {"name": "N", "steps": [good]}).status == 404
    assert layers(server) == before and server.get("/jobs").json()["total"] == jobs


def test_a_step_that_fails_leaves_no_layer(server):
    before, in_trash = layers(server), trash(server)
    steps = [
        {"layer": {"name": "First", "expression": "moisture * 1000"}},
        {"layer": {"name": "Second", "type": "u8", "expression": "first + 1"}},
        {"statistics": {"layer": "second"}},
    ]
    job = server.wait_for_job(analyse(server, steps))
    assert job["state"] == "failed" and "layers" not in job and "analysis" not in job, job
    assert job["problem"]["field"] == "steps[1].layer.type", job
    assert job["problem"]["detail"].startswith("Step 2 of 3: "), job
    assert layers(server) == before and trash(server) == in_trash
    # the names can be used again
    steps[1]["layer"]["type"] = "u16"
    job = server.wait_for_job(analyse(server, steps))
    assert job["state"] == "done", job
    assert job["analysis"]["steps"][2]["statistics"]["max"] == 751, job


def test_a_cancelled_analysis_leaves_no_layer(server):
    before, in_trash = layers(server), trash(server)
    shade = {"kind": "ambient_occlusion", "rays": 1024}
    steps = [
        {"layer": {"name": "Third", "expression": "moisture + 1"}},
        {"layer": {"name": "Shade", "resolution": 4096, "compute": shade}},
    ]
    job = analyse(server, steps)
    running = wait_for(
        lambda: (lambda now: now if now["message"].startswith("Step 2 of 2") else None)(
            server.ok("GET", f"/jobs/{job}").json()
        ),
        "the second step",
    )
    assert running["state"] == "running" and 0.5 <= running["progress"] <= 1, running
    server.ok("DELETE", f"/jobs/{job}")
    assert server.wait_for_job(job)["state"] == "cancelled"
    assert layers(server) == before and trash(server) == in_trash


def test_only_curators_run_analyses(server, story):
    body = {"name": "Mine", "steps": [{"layer": {"name": "Mine", "expression": "moisture"}}]}
    for user, role in (("vera", "viewer"), ("anna", "annotator")):
        token = server.add_person(user, role)
        assert server.post(M + "/analysis", body, token=token).status == 403, role
        job = server.ok("GET", f"/jobs/{story.job}", token=token).json()
        assert job["state"] == "done" and "analysis" not in job, "it names layers of curators"
    carl = server.add_person("carl", "curator")
    job = server.wait_for_job(analyse(server, body["steps"], name="Mine", token=carl))
    assert job["state"] == "done" and job["analysis"]["user"] == "carl", job


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
