"""Jobs that a restart of the server ends. Every user who could see these jobs can read their
outcome, no failed job is reported as a success, and no data remain.

The server is killed, or stopped in the normal way, while an import runs and another one waits. It
is also killed several times, at different moments of an import. The reference is then the list of
models."""
import os
import urllib.parse

import pytest
from support.meshes import folded_grid
from support.project_sites import Someone
from support.strata_server import wait_for

# the number of kills during an import
KILLS = int(os.environ.get("STRATA_LOST_JOBS", "5"))


SCAN = folded_grid(cells=120)  # some seconds of work for the server


def begin(server, name):
    return server.ok(
        "POST", "/models?" + urllib.parse.urlencode({"filename": "grid.ply", "name": name}), SCAN
    ).json()["id"]


def check_lost(server, jobs, outsider):
    listed = {job["id"]: job for job in server.ok("GET", "/jobs?limit=1000").json()["jobs"]}
    for job in jobs:
        answer = server.ok("GET", f"/jobs/{job}").json()
        assert answer["state"] == "failed", answer
        assert answer["problem"]["title"] == "Server restarted", answer
        assert (
            "did not save any part of it" in answer["problem"]["detail"]
            and "Start the import again" in answer["problem"]["detail"]
        ), answer
        assert "model" not in answer, answer
        assert listed[job] == answer, (listed[job], answer)
        assert server.request("DELETE", f"/jobs/{job}").status == 409
        assert outsider.status("GET", f"/jobs/{job}") == 404, "who may not see it is told of it"
    assert all(
        job["id"] not in jobs for job in outsider.ok("GET", "/jobs?limit=1000").json()["jobs"]
    )


def models(server):
    return {model["name"] for model in server.ok("GET", "/models?limit=1000").json()["models"]}


@pytest.fixture(scope="module")
def outsider(server):
    return Someone(server, "otto", "guest")  # has no role in any project


def test_a_job_that_ended_is_known_after_a_restart_with_what_it_made(server, story):
    story.done = done = server.wait_for_job(begin(server, "Kept"))
    assert done["state"] == "done", done
    failed = server.wait_for_job(
        server.ok("POST", "/models?filename=bad.ply", b"not a mesh").json()["id"]
    )
    assert failed["state"] == "failed", failed
    assert server.stop() == 0
    server.start()
    for before in (done, failed):
        now = server.ok("GET", f"/jobs/{before['id']}").json()
        assert {**now, "progress": 0} == {**before, "progress": 0}, (now, before)


@pytest.mark.parametrize("how", ("kill", "stop"))
def test_what_runs_and_what_waits_is_lost(server, outsider, how):
    started = {
        name: begin(server, name)
        for name in (f"Runs at {how}", f"Waits at {how}", f"Waits longer at {how}")
    }
    first = started[f"Runs at {how}"]
    wait_for(
        lambda: server.ok("GET", f"/jobs/{first}").json()["state"] != "queued",
        "the job to run",
    )
    getattr(server, how)()
    server.start()
    there = models(server)
    lost = {
        name: job
        for name, job in started.items()
        if server.ok("GET", f"/jobs/{job}").json()["state"] != "done"
    }
    assert (
        f"Waits longer at {how}" in lost
    ), "all were done before the server ended: give them more to do"
    assert not there & lost.keys() and started.keys() - lost.keys() <= there, (there, lost)
    check_lost(server, list(lost.values()), outsider)


def test_a_job_is_done_exactly_where_its_model_is_there(server):
    """Kills the server at different moments of an import."""
    for n in range(KILLS):
        job = begin(server, f"Model {n}")
        # The moment is a share of the work and not of the time. Each round kills the server later
        # than the round before.
        wait_for(
            lambda: (lambda now: now["progress"] >= n / KILLS or now["state"] == "done")(
                server.ok("GET", f"/jobs/{job}").json()
            ),
            "progress",
        )
        server.kill()
        server.start()
        answer = server.ok("GET", f"/jobs/{job}").json()
        assert (answer["state"] == "done") == (f"Model {n}" in models(server)), answer
        assert answer["state"] in ("done", "failed"), answer


def test_what_was_lost_is_started_again_under_the_same_key(server):
    """New jobs also get new ids."""
    key = {"Idempotency-Key": "again-and-again"}
    job = server.ok("POST", "/models?filename=grid.ply&name=Again", SCAN, headers=key).json()["id"]
    server.kill()
    server.start()
    if server.ok("GET", f"/jobs/{job}").json()["state"] != "done":
        repeated = server.ok(
            "POST", "/models?filename=grid.ply&name=Again", SCAN, headers=key
        ).json()["id"]
        assert repeated > job
        assert server.wait_for_job(repeated)["state"] == "done"
    assert "Again" in models(server)


def test_after_seven_days_it_is_forgotten(server, story):
    server.sql("UPDATE jobs SET ended = ended - interval '8 days'")
    assert server.stop() == 0
    server.start()
    assert server.get(f"/jobs/{story.done['id']}").status == 404
    server.assert_clean_log(warnings=["PostgreSQL", "not properly shut down", "interrupted"])
