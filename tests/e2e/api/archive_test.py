"""The archive of the private database: the site is restored as it was at a moment, the archive is
checked by a restore, and interrupted copies and wrong requests are handled."""
import datetime
import math
import os
import signal
import subprocess
import tempfile
import time

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"
LAYERS = ("moisture", "cracks")


def strata(*words, **more):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], *words], capture_output=True, text=True, check=False, **more
    )


def refused(*words, told):
    done = strata(*words)
    assert done.returncode == 1 and told in done.stderr, (words, done)


def moment():
    """Returns a moment after all earlier changes and before all later changes."""
    at_ms = math.ceil(time.time() * 1000)
    while time.time() * 1000 <= at_ms:
        time.sleep(0.001)
    since_1970 = datetime.datetime(1970, 1, 1) + datetime.timedelta(milliseconds=at_ms)
    return since_1970.isoformat(timespec="milliseconds") + "Z"


def paint(server, camera, layer, value, x):
    edit = {
        "op": "stroke",
        "value": value,
        "camera": camera,
        "radius_px": 9,
        "path": [[x, 150], [x + 90, 260]],
    }
    return server.ok("POST", f"{M}/layers/{layer}/edits", edit).json()["sequence"]


def contents(server):
    """Returns all content that the test changes."""
    layers = {}
    for layer in LAYERS:
        layers[layer] = (
            server.ok("GET", f"{M}/layers/{layer}/texels.npy").body,
            server.ok("GET", f"{M}/layers/{layer}/edits?limit=1000").json()["edits"],
        )
    model = server.ok("GET", M).json()
    records = server.ok("GET", "/tables/cracks/records").json()["records"]
    return layers, records, model["id"], model["atlas"]


def counts(server):
    """Returns the counts that `strata restore` also reports: projects, models and edits."""
    projects, models, edits = (
        int(server.sql(f"SELECT count(*) FROM {table}"))
        for table in ("projects", "models", "edits")
    )
    assert edits > 1
    return (
        f"{projects} project{'' if projects == 1 else 's'}, "
        f"{models} model{'' if models == 1 else 's'}, {edits} edits"
    )


def complete_copies(archive):
    try:
        names = os.listdir(os.path.join(archive, "copies"))
    except FileNotFoundError:
        return []
    return sorted(name for name in names if not name.endswith(".part"))


def unfinished_copies(archive):
    try:
        names = os.listdir(os.path.join(archive, "copies"))
    except FileNotFoundError:
        return []
    return [name for name in names if name.endswith(".part")]


def archive_now(server, archive):
    """Ends the current WAL segment, and waits until it is in the archive."""
    segment = server.sql("SELECT pg_walfile_name(pg_switch_wal())")
    wait_for(
        lambda: os.path.exists(os.path.join(archive, "wal", segment + ".gz")),
        f"the archived segment {segment}",
    )


@pytest.fixture(scope="module")
def folder():
    with tempfile.TemporaryDirectory(prefix="strata-archive-", dir="/tmp") as made:
        os.chmod(made, 0o755)
        yield made


@pytest.fixture(scope="module")
def archive(folder):
    return os.path.join(folder, "the archive")


@pytest.fixture(scope="module")
def server(archive):
    with StrataServer(options=["--archive", archive, "--archive-copies", "2"]) as started:
        yield started


@pytest.fixture(scope="module")
def second():
    """A server with an empty folder that has not started yet."""
    second = StrataServer()
    yield second
    second.remove()


def test_the_server_makes_a_copy_at_its_first_start(server, archive):
    wait_for(lambda: complete_copies(archive), "the first copy")

    def values():
        lines = server.request("GET", "//metrics", token=False).body.decode().splitlines()
        return dict(line.rsplit(" ", 1) for line in lines if not line.startswith("#"))

    wait_for(lambda: float(values()["strata_archive_copy_seconds"]) > 0, "the metric of the copy")
    archive_now(server, archive)
    wait_for(lambda: float(values()["strata_archive_segment_seconds"]) > 0, "that of the segment")
    assert values()['strata_archive_failures_total{of="segment"}'] == "0"
    assert values()['strata_archive_failures_total{of="copy"}'] == "0"
    assert os.stat(archive).st_mode & 0o077 == 0  # the copies contain password hashes
    assert "Archive: last segment at" in strata("doctor", "--data", server.data).stdout


def test_people_work_and_something_is_deleted(server, archive, story):
    model = server.import_model(folded_grid(30), "sheet.ply", name="Sheet", unit="mm")
    server.ok("POST", M + "/layers", {"name": "moisture", "type": "f32", "resolution": 2048})
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "cracks",
            "type": "u8",
            "kind": "database",
            "resolution": 2048,
            "columns": [{"name": "note", "kind": "text"}],
        },
    )
    server.ok("POST", "/tables/cracks/records", {"values": {"note": "größer"}})
    camera = camera_from(model, (0.2, 0.3, 1))
    paint(server, camera, "moisture", 0.5, 150)
    paint(server, camera, "cracks", 1, 200)
    story.before = contents(server)
    story.edits_before = counts(server)
    story.at = moment()
    paint(server, camera, "moisture", 0.75, 180)
    server.ok("POST", "/tables/cracks/records", {"values": {"note": "later"}})
    server.ok("DELETE", M + "/layers/cracks", headers={"If-Match": "*"})
    archive_now(server, archive)
    story.edits = counts(server)


def test_the_archive_is_checked_by_a_restore(archive, folder, story):
    scratch = os.path.join(folder, "scratch")
    os.mkdir(scratch)
    os.chmod(scratch, 0o755)
    done = strata("restore", "--archive", archive, "--check", env={**os.environ, "TMPDIR": scratch})
    assert done.returncode == 0 and "the archive is good" in done.stdout, done
    assert story.edits in done.stdout, (story.edits, done)
    assert os.listdir(scratch) == []


def test_wrong_requests_are_refused(server, archive, folder, second):
    common = ("restore", "--archive", archive, "--data", second.data)
    refused(*common, "--at", "2001-01-01T00:00", told="Before the first copy")
    refused(*common, "--at", "2999-01-01T00:00:00Z", told="Moment in the future")
    refused(*common, "--at", "half past two", told="Invalid moment")
    refused("restore", "--archive", archive, "--data", server.data, told="Data folder not empty")
    refused("restore", "--archive", folder, "--data", second.data, told="Archive not found")
    refused(*common, "--database", "host=none", told="Not a data folder")
    assert strata("restore", "--data", second.data).returncode == 2
    assert strata("restore", folder, "--archive", archive).returncode == 2
    assert strata("restore", folder, "--at", "2999-01-01").returncode == 2
    assert os.listdir(second.data) == []

    serve = ("serve", "--listen", "127.0.0.1:0", "--data", second.data, "--archive")
    refused(*serve, os.path.join(second.data, "archive"), told="Archive in the data folder")
    refused(*serve, archive, "--database", "host=none", told="pgBackRest")
    refused(*serve, archive, told="Archive of another site")
    subprocess.run(["rm", "-rf", os.path.join(second.data, "postgres")], check=True)


def test_the_site_is_restored_as_it_was(server, archive, second, story):
    for name in os.listdir(second.data):
        subprocess.run(["rm", "-rf", os.path.join(second.data, name)], check=True)
    done = strata("restore", "--archive", archive, "--data", second.data, "--at", story.at)
    assert done.returncode == 0, done
    assert f"restoring the state at {story.at}" in done.stdout, done
    assert story.edits_before in done.stdout, (story.edits_before, done)
    assert story.edits_before != story.edits
    assert os.listdir(second.data) == ["postgres"]
    with second:
        assert contents(second) == story.before
        camera = camera_from(second.ok("GET", M).json(), (0.2, 0.3, 1))
        paint(second, camera, "cracks", 1, 260)
        assert second.stop() == 0
        second.assert_clean_log()
    names = [layer["name"] for layer in server.ok("GET", M + "/layers").json()["layers"]]
    assert names == ["moisture"], "the restore does not change the original"


def test_a_restored_site_needs_a_new_archive(archive, folder):
    third = os.path.join(folder, "third")
    assert strata("restore", "--archive", archive, "--data", third).returncode == 0
    refused(
        *("serve", "--listen", "127.0.0.1:0", "--data", third, "--archive", archive),
        told="Archive of another site",
    )


def test_a_stopped_server_has_archived_every_change(server, archive, folder):
    camera = camera_from(server.ok("GET", M).json(), (0.2, 0.3, 1))
    paint(server, camera, "moisture", 0.25, 300)
    newest = counts(server)
    assert server.stop() == 0
    server.assert_clean_log()
    last = os.path.join(folder, "last")
    # Nothing was changed after the server stopped, so the archive does not cover this moment.
    late = moment()
    refused(
        *("restore", "--archive", archive, "--data", last, "--at", late),
        told="After the last archived change",
    )
    done = strata("restore", "--archive", archive, "--data", last)
    assert done.returncode == 0 and newest in done.stdout, done


def test_a_killed_server_leaves_no_copy_that_looks_complete(folder):
    archive = os.path.join(folder, "interrupted")
    with StrataServer(options=["--archive", archive]) as site:
        # The first start creates the archive. The next start makes a copy again.
        wait_for(lambda: complete_copies(archive), "the first copy")
        assert site.stop() == 0
        subprocess.run(
            ["rm", "-rf", os.path.join(archive, "copies", complete_copies(archive)[0])], check=True
        )
        child = subprocess.Popen(
            [site.binary, "serve", "--data", site.data, "--listen", site.listen, *site.options],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        wait_for(
            lambda: unfinished_copies(archive) or child.poll() is not None, "the copy to begin"
        )
        child.send_signal(signal.SIGKILL)
        child.wait()
        assert not complete_copies(archive), "it was quicker than its end: make the site larger"
        assert "No complete copy" in strata("restore", "--archive", archive, "--check").stderr
        site.start()
        wait_for(lambda: complete_copies(archive), "the copy after the restart")
        assert not unfinished_copies(archive)
        done = strata("restore", "--archive", archive, "--check")
        assert done.returncode == 0, done
