"""The information for administrators about the work of a server: traces of requests and edits, the
levels and the format of the log, metrics, and the bundle for reports of problems."""
import json
import os
import re
import stat
import subprocess
import uuid
import zipfile

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid
from support.strata_server import LONG_S, StrataServer, wait_for

M = "/models/sheet"
L = M + "/layers/cracks"
SPAN = "00f067aa0ba902b7"
TRACEPARENT = re.compile(r"00-([0-9a-f]{32})-([0-9a-f]{16})-0[01]")
# Turns off the detection of slow work, because the lines of slow work have other messages.
DEBUG = ["--log-format", "json", "--log-level", "info,net=debug,room=debug,store=debug"]
DEBUG += ["--slow-after", "0"]


@pytest.fixture(scope="module")
def server():
    with StrataServer(options=DEBUG) as started:
        started.import_model(
            folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
        )
        started.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
        yield started


@pytest.fixture(scope="module")
def camera(server):
    return camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))


def new_trace():
    return uuid.uuid4().hex


def header(trace):
    return {"traceparent": f"00-{trace}-{SPAN}-01"}


def lines_of(server, trace=None):
    """Returns the lines of the log, of one trace if it is given. Every line must be JSON."""
    lines = [json.loads(line) for line in list(server.log)]
    return [line for line in lines if trace is None or line.get("trace_id") == trace]


def line_of(server, trace, message):
    """Waits for the line of a trace with this message."""
    return wait_for(
        lambda: next(
            (line for line in lines_of(server, trace) if line["message"] == message), None
        ),
        f"a line `{message}` of the trace {trace}",
    )


def trace_in(answer):
    found = TRACEPARENT.fullmatch(answer.headers["traceparent"])
    assert found, answer.headers["traceparent"]
    return found[1], found[2]


def fill(server, value, **more):
    body = {"op": "fill", "mode": "where", "where": "true", "value": value}
    return server.ok("POST", L + "/edits", body, **more)


# --- traces


def test_the_answer_continues_the_trace_of_the_request(server):
    trace = new_trace()
    answer = server.ok("GET", "/version", headers=header(trace))
    assert trace_in(answer)[0] == trace and trace_in(answer)[1] != SPAN
    assert answer.headers["traceparent"].endswith("-01")
    refused = server.request("GET", "/models/nothing", headers=header(trace))
    assert refused.status == 404 and trace_in(refused)[0] == trace


def test_a_request_without_a_valid_trace_begins_a_new_one(server):
    trace = new_trace()
    seen = {trace}
    for sent in (
        {},
        {"traceparent": ""},
        {"traceparent": "nonsense"},
        {"traceparent": f"01-{trace}-{SPAN}-01"},
        {"traceparent": f"00-A{trace[1:]}-{SPAN}-01"},
        {"traceparent": f"00-{'0' * 32}-{SPAN}-01"},
        {"traceparent": f"00-{trace}-{'0' * 16}-01"},
        {"traceparent": f"00-{trace}-{SPAN}-01-more"},
    ):
        own = trace_in(server.ok("GET", "/version", headers=sent))[0]
        assert own not in seen, (sent, own)
        seen.add(own)


def test_a_request_with_two_traces_begins_a_new_one(server):
    traces = new_trace(), new_trace()
    link = server.connect()
    link.putrequest("GET", "/api/v1/version")
    for trace in traces:
        link.putheader("traceparent", header(trace)["traceparent"])
    link.endheaders()
    answer = link.getresponse()
    answer.read()
    link.close()
    assert answer.status == 200 and trace_in(answer)[0] not in traces


def test_the_log_lists_the_stages_of_an_edit_under_the_trace_of_its_request(server):
    trace = new_trace()
    assert trace_in(fill(server, 1, headers=header(trace)))[0] == trace
    edit = line_of(server, trace, "edit saved")
    assert edit["module"] == "room" and edit["op"] == "fill", edit
    for stage in ("queue_ms", "compute_ms", "gpu_ms", "journal_ms", "total_ms"):
        assert edit[stage] >= 0, (stage, edit)
    assert edit["total_ms"] >= edit["journal_ms"] > 0, edit
    request = line_of(server, trace, "request")
    assert request["module"] == "net" and request["status"] == 200, request
    assert request["method"] == "POST" and request["path"].endswith("/edits"), request
    commit = line_of(server, trace, "journal: committed")
    assert commit["module"] == "store" and commit["entries"] >= 1, commit


def test_all_batches_of_a_stroke_belong_to_its_trace(server, camera):
    trace, stroke = new_trace(), str(uuid.uuid4())
    live = LiveClient(server, "sheet")
    live.send({"op": "hello"})
    live.receive_until("welcome")
    live.send(
        {
            "op": "stroke.begin",
            "id": str(uuid.uuid4()),
            "stroke": stroke,
            "layer": "cracks",
            "value": 2,
            "camera": camera,
            "radius_px": 10,
            **header(trace),
        }
    )
    for n in range(2):
        live.send(
            {
                "op": "stroke.extend",
                "id": str(uuid.uuid4()),
                "stroke": stroke,
                "n": n,
                "path": [[300 + 10 * n, 240], [305 + 10 * n, 240]],
            }
        )
        live.receive_until("saved")

    def strokes():
        return [line for line in lines_of(server, trace) if line["message"] == "edit saved"]

    wait_for(lambda: len(strokes()) == 2, "the lines of two batches")
    for line in strokes():
        assert line["op"] == "stroke" and "compute_ms" not in line, line
        assert line["gpu_ms"] >= line["paint_ms"] > 0, line
    # The trace is for the log only.
    assert "traceparent" not in server.get(L + "/edits").body.decode()
    live.send({"op": "undo", "id": str(uuid.uuid4()), "layer": "cracks", "traceparent": "nonsense"})
    live.receive_until("saved")


def test_a_refused_edit_has_its_reason_in_the_log(server):
    trace = new_trace()
    refused = server.request("POST", L + "/redo", {}, headers=header(trace))
    while refused.status == 200:  # the undo of the stroke above
        refused = server.request("POST", L + "/redo", {}, headers=header(trace))
    assert refused.status == 409, refused
    line = line_of(server, trace, "edit refused")
    assert line["level"] == "debug" and line["problem"] == "conflict", line


# --- levels


def test_an_administrator_changes_the_levels_while_the_server_runs(server):
    started = {
        "default": "info",
        "modules": [
            {"module": "net", "level": "debug"},
            {"module": "room", "level": "debug"},
            {"module": "store", "level": "debug"},
        ],
    }
    assert server.get("/log-levels").json() == started
    only_net = {"default": "info", "modules": [{"module": "net", "level": "debug"}]}
    assert server.ok("PUT", "/log-levels", only_net).json() == only_net
    assert server.get("/log-levels").json() == only_net
    quiet = new_trace()
    fill(server, 3, headers=header(quiet))
    line_of(server, quiet, "request")  # a line of the edit would be before this line
    assert {line["module"] for line in lines_of(server, quiet)} == {"net"}
    server.ok("PUT", "/log-levels", started)
    loud = new_trace()
    fill(server, 4, headers=header(loud))
    line_of(server, loud, "edit saved")


def test_wrong_levels_change_nothing(server):
    before = server.get("/log-levels").json()
    store = {"module": "store", "level": "info"}
    for body, field in (
        ({"modules": []}, "default"),
        ({"default": "loud", "modules": []}, "default"),
        ({"default": "info", "modules": [{"module": "shop", "level": "info"}]}, "modules"),
        ({"default": "info", "modules": [store, store]}, "modules"),
        ({"default": "info"}, "modules"),
    ):
        refused = server.request("PUT", "/log-levels", body)
        assert refused.status in (400, 422), (body, refused)
        assert refused.json().get("field", "").startswith(field), (body, refused)
    viewer = server.add_person("lovelace", "viewer")
    for method, body in (("GET", None), ("PUT", before)):
        assert server.request(method, "/log-levels", body, token=viewer).status == 403
        assert server.request(method, "/log-levels", body, token=False).status == 401
    assert server.get("/log-levels").json() == before


def test_wrong_options_of_the_log_end_with_a_reason():
    for words in (
        ["--log-level", "loud"],
        ["--log-level", "shop=debug"],
        ["--log-level", "info,debug"],
        ["--log-format", "xml"],
        ["--slow-after", "-1"],
    ):
        done = strata("serve", "--data", "/nonexistent/data", *words)
        assert done.returncode == 2 and done.stderr, (words, done)
    done = strata("serve", "--data", "/nonexistent/data", STRATA_LOG_LEVEL="shop=debug")
    assert done.returncode == 2 and "shop" in done.stderr, done


# --- metrics


def test_the_metrics_have_the_times_of_edits_and_the_limits(server):
    text = server.get("//metrics").body.decode()
    values = dict(re.findall(r"^(strata_\w+(?:\{[^}]*\})?) (\S+)$", text, re.M))
    of_strokes = 'kind="stroke",stage="total"'
    assert float(values[f"strata_edit_stage_seconds_count{{{of_strokes}}}"]) >= 2
    assert float(values[f"strata_edit_stage_seconds_sum{{{of_strokes}}}"]) > 0
    for name in ("strata_gpu_ready", "strata_database_ready", "strata_journal_accepting"):
        assert values[name] == "1", name
    for name in ("gpu_limit_bytes", "memory_limit_bytes", "process_resident_bytes", "disk_bytes"):
        assert float(values["strata_" + name]) > 0, name
    assert float(values['strata_problems_total{code="not_found"}']) >= 1
    assert float(values["strata_journal_commit_seconds_count"]) >= 1
    assert "strata_certificate_end_seconds" not in text


# --- the support bundle


def strata(*words, **environment):
    return subprocess.run(
        [os.environ["STRATA_BINARY"], *words],
        capture_output=True,
        text=True,
        check=False,
        timeout=LONG_S,
        env={**os.environ, **environment},
    )


SQL_PASSWORD = "planted-sql-password"
DSN_PASSWORD = "heron-river-stone"


def secrets_of(server):
    link = server.link.partition("link=")[2]
    assert len(link) == 43, server.link
    return [server.token, link, SQL_PASSWORD, DSN_PASSWORD]


@pytest.fixture(scope="module")
def planted(server):
    with open(os.path.join(server.data, "sql-password"), "w", encoding="utf-8") as file:
        file.write(SQL_PASSWORD + "\n")
    return server


def bundle_of(server, path, *words):
    return strata(
        "doctor",
        "--data",
        server.data,
        "--listen",
        f"127.0.0.1:{server.port}",
        "--support",
        str(path),
        *words,
        STRATA_OWNER_TOKEN=server.token,
    )


def content_of(path):
    with zipfile.ZipFile(path) as bundle:
        assert bundle.testzip() is None
        return {name: bundle.read(name).decode() for name in bundle.namelist()}


def test_the_bundle_has_no_secret_and_no_name(planted, tmp_path):
    server = planted
    log = tmp_path / "strata.log"
    log.write_text(
        f"owner link: {server.link}\n"
        f"Authorization: Bearer {server.token}\n"
        "lovelace painted, and Lovelace undid it\n"
        "the line before the last\n"
    )
    file = tmp_path / "support.zip"
    done = bundle_of(server, file, "--log-file", str(log))
    assert done.returncode == 0 and str(file) in done.stdout, done
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    content = content_of(file)
    expected = {
        "MANIFEST.txt",
        "version.json",
        "checks.txt",
        "graphics.json",
        "machine.json",
        "settings.json",
        "database.json",
        "migrations.json",
        "tables.json",
        "indexes.json",
        "metrics.txt",
        "readyz.json",
        "logs/1.log",
    }
    assert expected <= set(content), sorted(content)
    for name, text in content.items():
        assert name == "MANIFEST.txt" or name in content["MANIFEST.txt"], name
        if name.endswith(".json"):
            json.loads(text)
        for secret in secrets_of(server):
            assert secret not in text, (name, secret)
        assert "lovelace" not in text.lower(), name
    assert "the line before the last" in content["logs/1.log"]
    assert "person-" in content["logs/1.log"]
    assert "strata_build_info" in content["metrics.txt"]
    assert json.loads(content["settings.json"])["environment"]["STRATA_OWNER_TOKEN"] == "[set]"
    assert {"edits", "users"} <= {table["name"] for table in json.loads(content["tables.json"])}
    again = bundle_of(server, file)
    assert again.returncode == 1 and "exists" in again.stderr, again


def test_a_bundle_with_a_secret_is_not_written(planted, tmp_path):
    log = tmp_path / "strata.log"
    log.write_text(f"somebody wrote {SQL_PASSWORD} into the log\n")
    file = tmp_path / "support.zip"
    done = bundle_of(planted, file, "--log-file", str(log))
    assert done.returncode == 1 and "logs/1.log" in done.stderr, done
    assert SQL_PASSWORD not in done.stderr + done.stdout
    assert not file.exists() and list(tmp_path.iterdir()) == [log]


def test_the_password_of_the_database_is_left_out(planted, tmp_path):
    folder = os.path.join(planted.data, "postgres")
    with open(os.path.join(folder, "pgdata", "postmaster.pid"), encoding="ascii") as opened:
        port = opened.read().splitlines()[3]
    dsn = f"host={folder} port={port} user=strata dbname=strata password={DSN_PASSWORD}"
    file = tmp_path / "support.zip"
    done = bundle_of(planted, file, "--database", dsn)
    assert done.returncode == 0, done
    content = content_of(file)
    assert not any(DSN_PASSWORD in text for text in content.values())
    settings = json.loads(content["settings.json"])
    assert "user='strata'" in settings["database"], settings


def test_without_a_database_the_bundle_has_no_logs(planted, tmp_path):
    server = planted
    assert all(line["level"] != "error" for line in lines_of(server))
    assert server.stop() == 0
    assert lines_of(server)  # every line is JSON until the end
    log = tmp_path / "strata.log"
    log.write_text("lovelace painted\n")
    file = tmp_path / "support.zip"
    done = bundle_of(server, file, "--log-file", str(log))
    assert done.returncode == 0, done
    content = content_of(file)
    assert not any(name.startswith("logs/") for name in content), sorted(content)
    assert "logs: without the database" in content["MANIFEST.txt"]
    assert "metrics.txt" not in content and "tables.json" not in content


def test_text_lines_have_the_module_and_slow_work_is_logged():
    """With a limit of one millisecond, an import and its requests are slow."""
    with StrataServer(options=["--slow-after", "1"]) as server:
        server.import_model(
            folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
        )
        server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
        trace = new_trace()
        fill(server, 1, headers=header(trace))
        line = wait_for(
            lambda: next((line for line in server.log if "slow edit" in line), None),
            "the line of a slow edit",
        )
        assert re.search(r" I \[room\] slow edit op=\w+ .*total_ms=[\d.]+", line), line
        server.assert_clean_log()
