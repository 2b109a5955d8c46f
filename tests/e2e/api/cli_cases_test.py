"""The commands: their exit codes, the checks of `doctor`, which change nothing, and responses of
other programs."""
import http.server
import os
import subprocess
import tempfile
import threading

import pytest
from support.meshes import folded_grid
from support.strata_server import LONG_S, StrataServer

BINARY = os.environ["STRATA_BINARY"]


def strata(*words, **environment):
    return subprocess.run(
        [BINARY, *words],
        capture_output=True,
        text=True,
        check=False,
        timeout=LONG_S,
        env={**os.environ, **environment},
    )


@pytest.fixture
def folder():
    with tempfile.TemporaryDirectory(prefix="strata-cli-") as folder:
        yield folder


def test_wrong_usage_ends_with_a_reason(folder):
    data = os.path.join(folder, "unused")
    for words, environment in (
        (("serve", "--listen", "nonsense"), {}),
        (("serve", "--listen", "127.0.0.1:99999"), {}),
        (("serve",), {"STRATA_LISTEN": "nonsense"}),
        (("serve", "--nonsense"), {}),
        ((), {}),
        (("import", "--resolution", "1024", "a.ply"), {}),
        (("nonsense",), {}),
    ):
        done = strata(*words, **{"STRATA_DATA": data, **environment})
        assert done.returncode == 2 and done.stderr, (words, done)
    done = strata(
        "import",
        os.path.join(folder, "nothing.ply"),
        "--server",
        "http://127.0.0.1:1",
        "--token",
        "t",
        STRATA_DATA=data,
    )
    assert done.returncode == 1 and done.stderr, done
    assert not os.path.exists(data)
    # PostgreSQL does not run as root, so its user needs access to the folder
    os.chmod(folder, 0o755)
    done = strata("serve", "--listen", "0.0.0.0:0", STRATA_DATA=os.path.join(folder, "in-reach"))
    assert done.returncode == 1 and "strata user add" in done.stderr and not done.stdout, done


def test_what_answers_an_import_is_no_strata_server(folder):
    """If another program responds to the import, the command prints a reason and exits with 1."""
    scan = os.path.join(folder, "grid.ply")
    with open(scan, "wb") as file:
        file.write(folded_grid())
    answers = {}

    class Other(http.server.BaseHTTPRequestHandler):
        def answer(self):
            self.rfile.read(int(self.headers.get("Content-Length") or 0))
            body = answers["POST" if self.command == "POST" else self.path]
            self.send_response(200)
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        do_GET = do_POST = answer

        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Other) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        for said in (
            {"POST": b"<html>"},
            {"POST": b"[]"},
            {"POST": b'{"name":"x"}'},
            {"POST": b'{"id":1}', "/api/v1/jobs/1": b"<html>"},
            {"POST": b'{"id":1}', "/api/v1/jobs/1": b'{"state":7,"progress":0}'},
            {"POST": b'{"id":1}', "/api/v1/jobs/1": b'{"state":"done","progress":1}'},
            {
                "POST": b'{"id":1}',
                "/api/v1/jobs/1": b'{"state":"failed","progress":1,"problem":[]}',
            },
            {
                "POST": b'{"id":1}',
                "/api/v1/jobs/1": b'{"state":"done","progress":1,"model":5}',
                "/api/v1/models/5": b"hello",
            },
        ):
            answers.clear()
            answers.update(said)
            done = strata(
                "import", scan, "--server", f"http://127.0.0.1:{server.server_port}", "--token", "t"
            )
            assert done.returncode == 1 and "strata: " in done.stderr, (said, done)
        server.shutdown()


def listing(folder):
    return sorted(
        os.path.join(root, name)
        for root, folders, files in os.walk(folder)
        for name in folders + files
    )


def test_the_doctor_changes_nothing(folder):
    data = os.path.join(folder, "nothing here")
    done = strata("doctor", "--data", data)
    assert done.returncode == 0 and "the first start creates" in done.stdout, done
    assert not os.path.exists(data), "doctor made the data folder"
    with StrataServer() as server:
        done = strata("doctor", "--data", server.data)
        assert (
            done.returncode == 0
            and "a server is running" in done.stdout
            and "FAIL" not in done.stdout
        ), done
        assert server.get("//readyz").status == 200
        assert server.stop() == 0
        before = listing(server.data)
        done = strata("doctor", "--data", server.data)
        assert done.returncode == 0 and "not running" in done.stdout, done
        assert listing(server.data) == before, "doctor changed the data folder"
        server.assert_clean_log()
