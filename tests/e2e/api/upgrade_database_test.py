"""A site changes from PostgreSQL 15 of Debian 12 to PostgreSQL 17 of Debian 13: the plan, the
rehearsal during work, interruptions, the upgrade, and the return to version 15."""
import os
import shutil
import signal
import subprocess
import tempfile

import pytest
from support.cameras import camera_from
from support.contract import ROOT
from support.meshes import folded_grid
from support.missing import missing
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"
OLD = "/usr/lib/postgresql"
NEW = os.path.join(ROOT, "build", "deps", "debian13", "usr", "lib", "postgresql")
BOTH = f"{OLD}:{NEW}"

if not os.path.exists(os.path.join(NEW, "17", "bin", "pg_upgrade")):
    missing("PostgreSQL 17 is not unpacked: ./test does it (setup_newer_postgresql)")


class Server(StrataServer):
    versions = OLD  # the folders in which it finds the programs of PostgreSQL

    def environment(self):
        return {**super().environment(), "STRATA_POSTGRESQL": self.versions}


def environment(versions):
    return {**os.environ, "STRATA_POSTGRESQL": versions}


def strata(*words, versions=BOTH):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], *words],
        capture_output=True,
        text=True,
        check=False,
        env=environment(versions),
    )


def upgrade(server, *options, versions=BOTH):
    return strata("upgrade-database", "--data", server.data, *options, versions=versions)


def version_of(server, cluster="postgres"):
    with open(os.path.join(server.data, cluster, "pgdata", "PG_VERSION"), encoding="ascii") as file:
        return int(file.read())


def paint(server, camera, value):
    edit = {
        "op": "stroke",
        "value": value,
        "camera": camera,
        "radius_px": 9,
        "path": [[150 + 200 * value, 150], [240, 260]],
    }
    return server.ok("POST", f"{M}/layers/moisture/edits", edit).json()["sequence"]


def contents(server):
    return (
        server.ok("GET", f"{M}/layers/moisture/texels.npy").body,
        server.ok("GET", f"{M}/layers/moisture/edits?limit=1000").json()["edits"],
        server.ok("GET", "/tables/cracks/records").json()["records"],
        server.ok("GET", f"{M}/source/sheet.ply").body,
    )


def interrupt(server, number):
    """Starts the upgrade, and sends a signal while pg_upgrade runs."""
    reports = os.path.join(server.data, "upgrading", "postgres", "pgdata", "pg_upgrade_output.d")
    shutil.rmtree(reports, ignore_errors=True)  # of an earlier upgrade that was killed
    child = subprocess.Popen(
        [os.environ["STRATA_BINARY"], "upgrade-database", "--data", server.data, "--apply"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        env=environment(BOTH),
    )
    wait_for(lambda: os.path.exists(reports) or child.poll() is not None, "pg_upgrade to begin")
    child.send_signal(number)
    told = child.communicate()[1]
    assert version_of(server) == 15, "it was quicker than the signal"
    return child.returncode, told


@pytest.fixture(scope="module")
def server():
    # The upgraded database still owns the files outside. Otherwise the server logs a warning.
    with (
        tempfile.TemporaryDirectory(prefix="strata-files-", dir="/tmp") as folder,
        Server(options=["--files", os.path.join(folder, "files")]) as started,
    ):
        if version_of(started) != 15:
            missing("PostgreSQL 15 is not the newest version in " + OLD)
        yield started


def test_the_plan_says_what_will_happen_and_changes_nothing(server, story):
    model = server.import_model(folded_grid(30), "sheet.ply", name="Sheet", unit="mm")
    server.ok("POST", M + "/layers", {"name": "moisture", "type": "f32", "resolution": 2048})
    table = {"name": "cracks", "type": "u8", "kind": "database", "resolution": 2048}
    table["columns"] = [{"name": "note", "kind": "text"}]
    server.ok("POST", M + "/layers", table)
    server.ok("POST", "/tables/cracks/records", {"values": {"note": "größer"}})
    story.camera = camera_from(model, (0.2, 0.3, 1))
    paint(server, story.camera, 0.5)

    done = upgrade(server)
    assert done.returncode == 0 and "Nothing was changed" in done.stdout, done
    for told in ("PostgreSQL 15 in", "PostgreSQL 17 in", "pg_upgrade", "before-upgrade"):
        assert told in done.stdout, (told, done)
    assert "nothing to do" in upgrade(server, versions=OLD).stdout
    assert "upgrade-database" in strata("doctor", "--data", server.data).stdout
    assert strata("upgrade-database", "--apply", "--rehearse").returncode == 2
    assert upgrade(server, "--database", "host=none").returncode == 1
    assert "upgrading" not in os.listdir(server.data)


def test_it_is_rehearsed_while_people_work(server, story):
    refused = upgrade(server, "--apply")
    assert refused.returncode == 1 and "Stop the server first" in refused.stderr, refused
    done = upgrade(server, "--rehearse")
    assert done.returncode == 0 and "the rehearsal succeeded" in done.stdout, done
    assert "equal: " in done.stdout and "time: " in done.stdout, done
    assert "upgrading" not in os.listdir(server.data) and version_of(server) == 15
    paint(server, story.camera, 0.75)
    story.before = contents(server)


def test_an_interrupted_upgrade_leaves_the_old_database(server, story):
    assert server.stop() == 0
    interrupt(server, signal.SIGKILL)
    server.start()  # PostgreSQL 15 starts, even if the server of pg_upgrade still uses the data
    assert contents(server) == story.before
    assert server.stop() == 0
    code, told = interrupt(server, signal.SIGTERM)
    assert code == 1 and "Cancelled" in told and "has not changed" in told, (code, told)
    assert "upgrading" not in os.listdir(server.data)


def test_the_site_continues_with_the_new_version(server, story):
    done = upgrade(server, "--apply")
    assert done.returncode == 0 and "now uses PostgreSQL 17" in done.stdout, done
    assert version_of(server) == 17 and version_of(server, "postgres-15-before-upgrade") == 15
    assert "upgrading" not in os.listdir(server.data)
    server.versions = NEW
    server.start()
    assert contents(server) == story.before
    sequence = paint(server, story.camera, 0.25)
    assert sequence == 1 + max(edit["sequence"] for edit in story.before[1])
    assert server.stop() == 0
    server.assert_clean_log()


def test_the_way_back(server, story):
    def refused(told):
        serve = ("serve", "--data", server.data, "--listen", "127.0.0.1:0")
        done = strata(*serve, versions=NEW)
        assert done.returncode == 1 and told in done.stderr, (told, done)

    place = os.path.join(server.data, "postgres")
    os.rename(place, os.path.join(server.data, "postgres-17"))
    refused("Upgrade interrupted")
    os.rename(os.path.join(server.data, "postgres-15-before-upgrade"), place)
    refused("strata upgrade-database")
    done = upgrade(server, "--rehearse", "--dump")
    assert done.returncode == 0 and "the rehearsal succeeded" in done.stdout, done
    server.versions = OLD
    server.start()
    assert contents(server) == story.before
    assert server.stop() == 0
    server.assert_clean_log()
