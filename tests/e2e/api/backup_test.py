"""Backup of a site during painting, and its restore on another server. The restored state is
complete and belongs to one moment, and users can continue their work. Damaged backups are
refused."""
import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import uuid

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"
PHOTO = b"%PDF-1.4\n" + bytes(range(256)) * 2000


def strata(*words, **more):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], *words], capture_output=True, text=True, check=False, **more
    )


def refused(*words, told):
    done = strata(*words)
    assert done.returncode == 1 and told in done.stderr, (words, done)


def make_site(server):
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
            "columns": [{"name": "note", "kind": "text"}, {"name": "report", "kind": "document"}],
        },
    )
    for note in ("größer", "'; DROP TABLE x; --", ""):
        server.ok("POST", "/tables/cracks/records", {"values": {"note": note}})
    server.ok(
        "POST",
        "/tables/cracks/records/1/attachments?name=report.pdf&column=report",
        PHOTO,
        headers={"Content-Type": "application/pdf"},
    )
    poses = b"#name,x,y,alt,heading,pitch,roll,f\nnorth.png,50,50,300,0,0,0,35\n"
    server.ok("POST", M + "/photograph-poses?filename=poses.csv", poses)
    server.ok("POST", M + "/photographs?filename=north.png", png(24, 16, lambda x, y: (x, y, 9)))
    server.add_person("ada", "annotator")
    return camera_from(model, (0.2, 0.3, 1))


class Painters:
    """Three users who paint until `stop` is set."""

    def __init__(self, server, camera):
        self.acknowledged, self.changed, self.stopping, self.faults = (
            [],
            threading.Condition(),
            False,
            [],
        )
        self.threads = [
            threading.Thread(target=self.paint, args=(server, camera, number))
            for number in range(3)
        ]
        for thread in self.threads:
            thread.start()

    def paint(self, server, camera, number):
        link, n = server.connect(), 0
        try:
            while not self.stopping:
                n += 1
                layer, value = ("moisture", 0.01 * n) if n % 2 else ("cracks", 1 + n % 3)
                edit = {
                    "op": "stroke",
                    "value": value,
                    "camera": camera,
                    "radius_px": 6 + n % 9,
                    "path": [
                        [150 + 37 * n % 300, 100 + 53 * (n + number) % 250],
                        [180 + 29 * n % 300, 120 + 31 * n % 250],
                    ],
                }
                done = server.ok(
                    "POST",
                    f"{M}/layers/{layer}/edits",
                    edit,
                    headers={"Idempotency-Key": str(uuid.uuid4())},
                    connection=link,
                ).json()
                with self.changed:
                    self.acknowledged.append(done["sequence"])
                    self.changed.notify_all()
        except Exception as fault:  # `end` reports it
            with self.changed:
                self.faults.append(repr(fault))
                self.changed.notify_all()

    def wait_for(self, count):
        with self.changed:
            assert self.changed.wait_for(
                lambda: self.faults or len(self.acknowledged) >= count, 180
            ), "nobody paints"
            return list(self.acknowledged)

    def end(self):
        self.stopping = True
        for thread in self.threads:
            thread.join()
        assert not self.faults, self.faults


def contents(server, sequence):
    """Returns all readable content at a sequence."""
    layers = {}
    for layer in ("moisture", "cracks"):
        history = server.ok("GET", f"{M}/layers/{layer}/edits?limit=1000").json()["edits"]
        layers[layer] = (
            server.ok("GET", f"{M}/layers/{layer}/texels.npy?at={sequence}").body,
            [edit for edit in history if edit["sequence"] <= sequence],
        )
    attachments = server.ok("GET", "/tables/cracks/records/1/attachments").json()["attachments"]
    photographs = server.ok("GET", M + "/photographs").json()["photographs"]
    model = server.ok("GET", M).json()
    return (
        layers,
        photographs,
        [server.ok("GET", f"{M}/photographs/{each['id']}/picture").body for each in photographs],
        server.ok("GET", "/tables/cracks/records").json()["records"],
        [server.ok("GET", f"/attachments/{each['id']}").body for each in attachments],
        server.ok("GET", f"{M}/source/sheet.ply").body,
        model["id"],
        model["atlas"],
    )


def check_goes_on(server, camera, newest):
    """Checks that users can sign in with their passwords and undo earlier edits, and that keys and
    numbers are not reused."""
    signed = server.request(
        "POST",
        "/login",
        {"user": "ada", "password": "ada and seven blue herons"},
        headers={"Origin": server.url},
        token=False,
    )
    assert signed.status == 200, signed
    edit = {"op": "stroke", "value": 3, "camera": camera, "radius_px": 9, "path": [[320, 240]]}
    assert server.ok("POST", M + "/layers/cracks/edits", edit).json()["sequence"] == newest + 1
    server.ok("POST", M + "/layers/cracks/undo")
    server.ok("POST", M + "/layers/cracks/undo")
    assert (
        server.ok("POST", "/tables/cracks/records", {"values": {"note": "new"}}).json()["key"] == 4
    )


def check_bad_backups(whole, data, folder):
    def copy(name, change):
        bad = os.path.join(folder, name)
        shutil.copytree(whole, bad)
        change(os.path.join(bad, "database.dump"), os.path.join(bad, "manifest.json"))
        return bad

    def cut(dump, _):
        os.truncate(dump, os.path.getsize(dump) - 1)

    def flip(dump, _):
        with open(dump, "r+b") as file:
            file.seek(os.path.getsize(dump) // 2)
            byte = file.read(1)
            file.seek(-1, os.SEEK_CUR)
            file.write(bytes([byte[0] ^ 1]))

    def edit(change):
        def apply(_, manifest):
            with open(manifest, encoding="utf-8") as file:
                content = json.load(file)
            change(content)
            with open(manifest, "w", encoding="utf-8") as file:
                json.dump(content, file)

        return apply

    def garbage(_, manifest):
        with open(manifest, "wb") as file:
            file.write(b"\xff" * 100)

    for name, change, told in (
        ("cut", cut, " bytes were written"),
        ("flipped", flip, "checksum differs"),
        ("garbage", garbage, "manifest.json is not"),
        ("newer", edit(lambda m: m.update(schema_version=10**6)), "Newer backup"),
        ("format", edit(lambda m: m.update(format=99)), "Newer backup format"),
        ("types", edit(lambda m: m.update(tables=[1])), "manifest.json is not"),
        (
            "rows",
            edit(lambda m: m["tables"]["public.edits"].update(rows=1)),
            "public.edits differs from",
        ),
        (
            "missing",
            edit(lambda m: m["tables"].update({"public.gone": {"rows": 0, "digest": "0"}})),
            "public.gone differs from",
        ),
        (
            "sequence",
            edit(lambda m: m["sequences"].update({next(iter(m["sequences"])): 10**9})),
            "numbers that are in use",
        ),
    ):
        bad = copy(name, change)
        refused("restore", bad, "--data", data, told=told)
        if name in ("flipped", "rows"):  # the file is damaged, or the restored content differs
            refused("restore", bad, "--check", told=told)
        assert not os.path.exists(os.path.join(data, "postgres")) and not os.path.exists(
            os.path.join(data, "restoring")
        ), os.listdir(data)
        shutil.rmtree(bad)
    refused("restore", folder, "--data", data, told="Backup not found")


def check_killed_restore(whole, data):
    """An interrupted restore leaves no data that a server could start with. The restore can be
    repeated."""
    child = subprocess.Popen(
        [os.environ["STRATA_BINARY"], "restore", whole, "--data", data],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    wait_for(
        lambda: os.path.exists(os.path.join(data, "restoring", "postgres", "pgdata"))
        or child.poll() is not None,
        "the restore to begin",
    )
    child.send_signal(signal.SIGKILL)
    child.wait()
    assert not os.path.exists(
        os.path.join(data, "postgres")
    ), "it was quicker than its end: make the site larger"


@pytest.fixture(scope="module")
def folder():
    with tempfile.TemporaryDirectory(prefix="strata-backup-", dir="/tmp") as folder:
        os.chmod(folder, 0o755)
        yield folder


@pytest.fixture(scope="module")
def whole(folder):
    return os.path.join(folder, "busy")


@pytest.fixture(scope="module")
def second():
    """A server with an empty folder that has not started yet."""
    second = StrataServer()
    yield second
    second.remove()


def test_a_backup_is_made_while_people_paint(server, whole, story):
    story.camera = make_site(server)
    painters = Painters(server, story.camera)
    story.before = painters.wait_for(30)
    done = strata("backup", whole, "--data", server.data)
    # the backup did not block painting permanently
    painters.wait_for(len(painters.acknowledged) + 10)
    painters.end()
    assert done.returncode == 0 and "backed up 1 model, 2 layers" in done.stdout, done
    assert os.stat(whole).st_mode & 0o077 == 0  # the folder contains password hashes


def test_a_backup_is_checked_by_a_restore(whole, folder):
    scratch = os.path.join(folder, "scratch")
    os.mkdir(scratch)
    os.chmod(scratch, 0o755)
    done = strata("restore", whole, "--check", env={**os.environ, "TMPDIR": scratch})
    assert done.returncode == 0 and done.stdout.startswith("the backup is good: 1 model"), done
    assert os.listdir(scratch) == []
    os.rmdir(scratch)


def test_what_is_there_is_not_written_over(server, whole):
    refused("backup", whole, "--data", server.data, told="Folder already exists")
    refused("restore", whole, "--data", server.data, told="already contains a site")


def test_a_full_disk_is_no_backup(server, folder):
    """If the disk has no space for the dump, the backup is refused, and no folder remains that
    looks like a backup."""
    small = os.path.join(folder, "small")
    os.mkdir(small)
    if (
        subprocess.run(
            ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", small],
            capture_output=True,
            check=False,
        ).returncode
        != 0
    ):
        pytest.skip("no right to mount a small disk")
    try:
        done = strata("backup", os.path.join(small, "site"), "--data", server.data)
        assert done.returncode == 1 and "Disk full" in done.stderr, done
        assert os.listdir(small) == [], os.listdir(small)
    finally:
        subprocess.run(["umount", small], check=True)


def test_another_database(server, whole):
    """`--database` restores into an empty database, with a password that no process list shows."""
    socket_folder = os.path.join(server.data, "postgres")
    server.sql("CREATE DATABASE copy")
    copy = f"host='{socket_folder}' user=strata dbname=copy password='it\\'s a : secret'"
    done = strata("restore", whole, "--database", copy)
    assert done.returncode == 0 and "every table equals the backup" in done.stdout, done
    refused("restore", whole, "--database", copy, told="Database not empty")
    refused("restore", whole, "--database", "host=", told="strata: ")
    again = strata("backup", whole + "-copy", "--database", copy)
    assert again.returncode == 0, again
    manifests = [
        json.load(open(os.path.join(each, "manifest.json"), encoding="utf-8"))
        for each in (whole, whole + "-copy")
    ]
    assert manifests[0]["tables"] == manifests[1]["tables"]
    assert sorted(os.listdir(whole + "-copy")) == ["database.dump", "manifest.json"]


def test_damaged_backups_are_refused(whole, second, folder):
    check_bad_backups(whole, second.data, folder)


def test_a_restore_that_is_cut_short_leaves_nothing(whole, second):
    check_killed_restore(whole, second.data)


def test_a_backup_is_restored_elsewhere_and_work_goes_on(server, whole, second, story):
    done = wait_for(
        lambda: (lambda done: done if done.returncode == 0 else None)(
            strata("restore", whole, "--data", second.data)
        ),
        "the second try to restore",
    )
    assert "every table equals the backup" in done.stdout, done
    with second:
        newest = max(
            edit["sequence"]
            for layer in ("moisture", "cracks")
            for edit in second.ok("GET", f"{M}/layers/{layer}/edits?limit=1000").json()["edits"]
        )
        assert newest >= max(
            story.before
        ), "an edit that was acknowledged before the backup is missing"
        assert contents(second, newest) == contents(server, newest)
        check_goes_on(second, story.camera, newest)
        assert second.stop() == 0
        second.assert_clean_log()


def test_a_server_that_does_not_run_is_backed_up(server, folder):
    assert server.stop() == 0
    done = strata("backup", os.path.join(folder, "quiet"), "--data", server.data)
    assert done.returncode == 0, done
    server.assert_clean_log()


def test_nothing_is_backed_up_where_there_is_no_database(folder):
    refused(
        "backup",
        os.path.join(folder, "none"),
        "--data",
        os.path.join(folder, "nothing"),
        told="No database",
    )
    assert strata("backup").returncode == 2
