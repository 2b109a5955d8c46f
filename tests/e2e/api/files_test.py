"""Files outside the database, in a folder and in an S3 bucket: reading them unchanged, refusing
damaged files, moving and checking them, and their list in a backup and in its restore."""
import hashlib
import os
import subprocess
import tempfile

import pytest
from support.meshes import folded_grid
from support.s3_server import S3Server
from support.strata_server import StrataServer

SOURCE = "/models/sheet/source/sheet.ply"
PHOTO = b"%PDF-1.4\n" + bytes(range(256)) * 8000
MESH = folded_grid(30)


def strata(*words, **more):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], *words],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, **more},
    )


def name_of(content):
    digest = hashlib.sha256(content).hexdigest()
    return f"{digest[:2]}/{digest[2:4]}/{digest}"


def make_site(server):
    server.import_model(MESH, "sheet.ply", name="Sheet", unit="mm")
    columns = [{"name": "report", "kind": "document"}]
    layer = {"name": "cracks", "type": "u8", "kind": "database", "resolution": 2048}
    server.ok("POST", "/models/sheet/layers", {**layer, "columns": columns})
    server.ok("POST", "/tables/cracks/records", {"values": {}})
    made = server.ok(
        "POST",
        "/tables/cracks/records/1/attachments?name=report.pdf&column=report",
        PHOTO,
        headers={"Content-Type": "application/pdf"},
    )
    return f"/attachments/{made.json()['attachments'][0]['id']}"


def check_whole(server, report):
    source = server.ok("GET", SOURCE).body
    assert source == server.source
    assert server.ok("GET", report).body == PHOTO
    part = server.request("GET", report, headers={"Range": "bytes=1048570-1048579"})
    assert part.status == 206 and part.body == PHOTO[1048570:1048580], part


@pytest.fixture(scope="module")
def folder():
    with tempfile.TemporaryDirectory(prefix="strata-files-", dir="/tmp") as folder:
        os.chmod(folder, 0o755)
        yield folder


@pytest.fixture(scope="module")
def server(folder):
    with StrataServer(options=["--files", os.path.join(folder, "files")]) as started:
        yield started


def test_files_are_in_the_folder(server, folder, story):
    story.report = make_site(server)
    server.source = server.ok("GET", SOURCE).body
    story.files = os.path.join(folder, "files")
    story.photo = os.path.join(story.files, name_of(PHOTO))
    with open(story.photo, "rb") as file:
        assert file.read() == PHOTO
    assert os.stat(story.files).st_mode & 0o077 == 0
    assert os.path.exists(os.path.join(story.files, name_of(server.source)))
    check_whole(server, story.report)
    assert server.sql("SELECT count(*) FROM blob_chunks") == "0"


def test_a_changed_file_is_not_sent(server, story):
    with open(story.photo, "r+b") as file:
        file.write(b"X")
    refused = server.get(story.report)
    assert refused.status == 500 and refused.json()["type"] == "/problems#damaged", refused
    assert "%PDF" not in str(refused.body)
    tail = server.request("GET", story.report, headers={"Range": "bytes=2000000-2000009"})
    assert tail.status == 206 and tail.body == PHOTO[2000000:2000010]
    metrics = server.ok("GET", "//metrics").body.decode()
    assert 'strata_file_faults_total{kind="changed"} 1' in metrics
    assert any(name_of(PHOTO) in line for line in server.log)
    place = ("--data", server.data, "--files", story.files)
    checked = strata("files", "check", *place)
    assert checked.returncode == 1, checked
    assert f"changed {name_of(PHOTO)}" in checked.stdout and "report.pdf" in checked.stdout, checked
    with open(story.photo, "r+b") as file:
        file.write(PHOTO[:1])
    checked = strata("files", "check", *place)
    assert checked.returncode == 0 and "0 missing or changed, 0 super" in checked.stdout, checked
    check_whole(server, story.report)


def test_a_backup_names_the_files_and_its_restore_finds_them(server, folder, story):
    backup = os.path.join(folder, "backup")
    made = strata("backup", backup, "--data", server.data)
    assert made.returncode == 0 and "NOT in the backup" in made.stdout, made
    assert story.files in made.stdout
    copy = StrataServer()
    restored = strata("restore", backup, "--data", copy.data)
    assert restored.returncode == 0 and "strata files check" in restored.stdout, restored
    refused = strata("serve", "--data", copy.data, "--listen", "127.0.0.1:0")
    assert refused.returncode == 1 and story.files in refused.stderr, refused
    copy.options += ["--files", story.files]
    copy.source = server.source
    with copy:
        check_whole(copy, story.report)
        assert any("deletes no files" in line for line in copy.log)
        assert copy.stop() == 0


def test_content_moves_while_the_server_runs(server, story):
    place = ("--data", server.data, "--files", story.files)
    inside = strata("files", "move", "--to", "database", *place)
    assert inside.returncode == 0 and "moved " in inside.stdout, inside
    assert server.sql("SELECT count(*) FROM blobs WHERE is_outside") == "0"
    check_whole(server, story.report)
    shown = strata("files", "show", "--data", server.data)
    assert "outside: 0 files" in shown.stdout, shown
    assert server.stop() == 0
    server.options = []
    server.start()
    check_whole(server, story.report)
    other = StrataServer(options=["--files", story.files])
    other._fill()
    wrong = strata("serve", "--data", other.data, "--files", story.files)
    assert wrong.returncode == 1 and "another site" in wrong.stderr, wrong
    other.remove()


def test_files_are_in_a_bucket(monkeypatch):
    with S3Server() as bucket:
        for name, value in bucket.environment.items():
            monkeypatch.setenv(name, value)
        options = ["--files", "s3://strata/site", "--files-endpoint", bucket.endpoint]
        with StrataServer(options=options) as server:
            report = make_site(server)
            server.source = server.ok("GET", SOURCE).body
            key = "site/" + name_of(PHOTO)
            assert key in bucket.keys() and bucket.read(key) == PHOTO
            check_whole(server, report)
            bucket.replace(key, b"X" + PHOTO[1:])
            refused = server.get(report)
            assert refused.status == 500 and refused.json()["type"] == "/problems#damaged", refused
            bucket.replace(key, PHOTO)
            checked = strata("files", "check", "--data", server.data, *options)
            assert checked.returncode == 0, checked
            bucket.process.kill()
            bucket.process.wait()
            away = server.get(report)
            assert away.status == 503, away
            refused = server.post(
                "/tables/cracks/records/1/attachments?name=other.pdf&column=report",
                PHOTO + b"more",
                headers={"Content-Type": "application/pdf"},
            )
            assert refused.status == 503, refused
            listed = server.ok("GET", "/tables/cracks/records/1/attachments").json()
            assert listed["total"] == 1, listed
            secret = bucket.environment["AWS_SECRET_ACCESS_KEY"]
            assert not any(secret in line for line in server.log)
            assert server.stop() == 0
