"""`strata journal thin` removes old states while the server is running. The newest state, the state
at the end of each day, snapshots and undo stay exact. Other old states are gone (410)."""
import os
import subprocess

from support.merges import THINNING_MARKED_LONG_AGO
from support.meshes import folded_grid

M = "/models/sheet"
L = M + "/layers/cracks"
DAYS, EDITS_A_DAY = 3, 4
OLD = DAYS * EDITS_A_DAY
NAMED = 6


def strata(server, *words):
    return run_thin("--data", server.data, *words)


def run_thin(*words):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], "journal", "thin", *words],
        capture_output=True,
        text=True,
        check=False,
    )


def texels(server, at=None):
    return server.request("GET", f"{L}/texels.npy" + ("" if at is None else f"?at={at}"))


def fill(server, value):
    server.ok(
        "POST", L + "/edits", {"op": "fill", "mode": "where", "where": "true", "value": value}
    )


def test_an_administrator_thins_old_states(server):
    server.sql(THINNING_MARKED_LONG_AGO)
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    for value in range(1, OLD + 4):
        fill(server, value)
    server.ok("POST", M + "/snapshots", {"name": "Loan", "at": NAMED})
    # The first edits are from the morning of three days, almost a year ago.
    server.sql(
        "UPDATE edits SET time = date_trunc('day', now() AT TIME ZONE 'UTC') AT TIME ZONE 'UTC' "
        f"- interval '300 days' + (sequence - 1) / {EDITS_A_DAY} * interval '1 day' "
        f"+ sequence * interval '1 minute' WHERE sequence <= {OLD}"
    )
    before = {at: texels(server, at).body for at in range(OLD + 4)}

    for age, words in (("20d", "30 days"), ("999y", "100 years")):
        wrong = strata(server, "--older-than", age)
        assert wrong.returncode == 2 and words in wrong.stderr, wrong
    planned = strata(server, "--older-than", "200d")
    assert planned.returncode == 0, planned
    assert "Nothing has changed" in planned.stdout and "8 of 12 edits" in planned.stdout, planned
    assert server.ok("GET", L + "/edits").json()["total"] == OLD + 3
    done = strata(server, "--older-than", "200d", "--model", "sheet", "--yes")
    assert done.returncode == 0 and "removed 8 edits" in done.stdout, done

    kept = {0, EDITS_A_DAY, NAMED, 2 * EDITS_A_DAY, 3 * EDITS_A_DAY} | set(range(OLD, OLD + 4))
    for at, state in before.items():
        found = texels(server, at)
        assert found.status == (200 if at in kept else 410), (at, found)
        if at in kept:
            assert found.body == state, f"the state after edit {at} changed"
    gone = texels(server, 2).json()
    assert gone["type"].endswith("#gone") and "0 and 4" in gone["detail"], gone
    listed = server.ok("GET", L + "/edits?limit=100").json()
    oldest = listed["edits"][-1]
    assert oldest["op"] == "checkpoint" and oldest["people"][0]["edits"] == EDITS_A_DAY, oldest
    assert server.ok("GET", M + "/timeline").json()["edits"] == OLD + 3
    entry = server.ok("GET", "/audit?action=erased").json()["entries"][0]
    assert entry["subject_kind"] == "history" and entry["details"]["edits"] == 8, entry

    assert entry["subject"] == "Sheet", entry
    responses = server.sql("SELECT count(*) FROM edit_batches")
    assert responses == str(OLD), "the responses stay for a year"

    again = strata(server, "--older-than", "200d", "--yes")
    assert again.returncode == 0 and "removes 0 edits" in again.stdout, again
    server.sql(f"UPDATE edits SET time = time - interval '100 days' WHERE sequence <= {OLD}")
    assert strata(server, "--older-than", "200d", "--yes").returncode == 0
    assert server.sql("SELECT count(*) FROM edit_batches") == "0"
    for value in range(OLD + 2, OLD - 1, -1):
        server.ok("POST", L + "/undo")
        assert texels(server).body == before[value], f"undo does not restore {value}"
    refused = server.request("POST", L + "/undo")
    assert refused.status == 409, "edits in checkpoints cannot be undone"


def test_the_command_does_not_migrate_a_database(server):
    newest = server.sql("SELECT max(version) FROM schema_migrations")
    server.sql(
        f"CREATE TABLE newest AS SELECT * FROM schema_migrations WHERE version = '{newest}'; "
        f"DELETE FROM schema_migrations WHERE version = '{newest}'"
    )
    port = server.sql("SHOW port")
    database = f"host={server.data}/postgres port={port} user=strata dbname=strata"
    for place in (("--database", database), ("--data", server.data)):
        refused = run_thin(*place, "--older-than", "200d", "--yes")
        assert refused.returncode == 1 and "Version mismatch" in refused.stderr, refused
        assert server.sql("SELECT max(version) FROM schema_migrations") < newest
    server.sql("INSERT INTO schema_migrations SELECT * FROM newest; DROP TABLE newest")
