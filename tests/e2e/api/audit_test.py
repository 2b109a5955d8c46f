"""The audit log over HTTP and on the command line. It has entries for sign-ins, roles, exports,
deletions, visibility and kiosks, and contains no secrets. The tests also check who may read it, its
filters, its pages and its JSON lines."""
import json
import subprocess

import pytest
from support.browsers import PASSWORD, Browser, join
from support.meshes import folded_grid

M = "/models/sheet"


@pytest.fixture(scope="module", autouse=True)
def model(server):
    return server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")


def entries(server, **parameters):
    asked = "&".join(f"{name}={value}" for name, value in parameters.items())
    return server.ok("GET", "/audit" + ("?" + asked if asked else "")).json()["entries"]


def newest(server):
    return entries(server, limit=1)[0]


def lines(server, **parameters):
    asked = "&".join(f"{name}={value}" for name, value in {**parameters, "f": "jsonl"}.items())
    answer = server.ok("GET", "/audit?" + asked, headers={"Accept": "*/*"})
    assert answer.headers["Content-Type"] == "application/x-ndjson", answer
    return [json.loads(line) for line in answer.body.decode().splitlines()]


def test_sign_ins_and_accounts(server):
    invitation = server.ok("POST", "/users", {"user": "ada", "role": "annotator"}).json()
    ada = join(server, invitation)
    found = [(entry["action"], entry.get("actor")) for entry in entries(server, limit=5)]
    assert ("sign_in", "ada") in found and ("password_changed", "ada") in found, found
    entry = entries(server, action="sign_in", limit=1)[0]
    assert entry["actor_kind"] == "link" and entry["details"]["method"] == "invitation", entry
    assert entry["address"] == "127.0.0.1" and entry["subject"] == "ada", entry
    ada.ok("POST", "/logout")
    assert newest(server)["action"] == "sign_out"
    assert Browser(server).sign_in("ada", PASSWORD).status == 200
    entry = newest(server)
    assert entry["action"] == "sign_in" and entry["details"]["method"] == "password", entry
    for _ in range(3):
        assert Browser(server).sign_in("ada", "wrong and wrong").status == 401
    failed = entries(server, action="sign_in_failed")
    # the minute may change between two attempts
    assert sum(entry["count"] for entry in failed) == 3 and len(failed) <= 2, failed
    assert {entry["actor"] for entry in failed} == {"ada"}, failed
    server.ok("PATCH", "/users/ada", {"role": "viewer"})
    entry = newest(server)
    assert entry["action"] == "role_changed" and entry["subject"] == "ada", entry
    assert entry["details"] == {"before": "annotator", "after": "viewer"}, entry
    server.ok("PUT", "/projects/default/members/ada", {"role": "curator"})
    entry = newest(server)
    assert entry["action"] == "member_added" and entry["project_slug"] == "default", entry


def test_exports_have_an_entry_with_their_file(server):
    server.ok("POST", M + "/layers", {"name": "Cracks", "type": "u8"})
    before = newest(server)["id"]
    assert server.get(M + "/layers/cracks").status == 200
    assert newest(server)["id"] == before, "the page's reads are no exports"
    server.ok("GET", M + "/layers/cracks/texels.npy", headers={"Accept": "*/*"})
    entry = newest(server)
    assert (entry["action"], entry["subject_kind"]) == ("export", "layer"), entry
    assert entry["subject"] == "cracks.npy" and entry["project_slug"] == "default", entry
    assert entry["details"]["path"].endswith("/layers/cracks/texels.npy"), entry
    head = server.request("HEAD", M + "/layers/cracks/texels.npy", headers={"Accept": "*/*"})
    assert head.status == 200 and newest(server)["id"] == entry["id"], head
    server.ok("POST", M + "/figures", {"format": "png", "dpi": 50}, headers={"Accept": "*/*"})
    assert newest(server)["action"] == "export"


def test_deletions_and_visibility(server):
    server.ok("PATCH", M + "/layers/cracks", {"visibility": "team"}, headers={"If-Match": "*"})
    entry = newest(server)
    assert entry["action"] == "visibility_changed" and entry["subject"] == "Cracks", entry
    assert entry["details"] == {"before": "public", "after": "team"}, entry
    server.ok("DELETE", M + "/layers/cracks", headers={"If-Match": "*"})
    entry = newest(server)
    assert (entry["action"], entry["subject_kind"]) == ("deletion", "layer"), entry
    assert entries(server, subject_kind="layer", action="deletion") == [entry]


def test_only_administrators_read_it(server):
    curator = server.add_person("carl", "curator")
    assert server.request("GET", "/audit", token=curator).status == 403
    assert server.request("GET", "/audit", token=False).status == 401


def test_filters_pages_and_lines(server):
    whole = lines(server)
    assert [entry["id"] for entry in whole] == sorted((e["id"] for e in whole), reverse=True)
    # the download of the log is an export, too
    assert newest(server)["subject"] == "audit.jsonl"
    paged, path = [], "/audit?limit=3"
    while path:
        answer = server.ok("GET", path)
        paged += answer.json()["entries"]
        link = answer.headers["Link"] or ""
        path = link.partition("</api/v1")[2].partition(">")[0] if 'rel="next"' in link else ""
    assert [entry for entry in paged if entry["id"] <= whole[0]["id"]] == whole
    assert lines(server, actor="ADA") == [e for e in paged if e.get("actor") == "ada"]
    accepted = server.ok("GET", "/audit?action=sign_in", headers={"Accept": "application/x-ndjson"})
    assert [json.loads(line) for line in accepted.body.decode().splitlines()] == entries(
        server, action="sign_in"
    )
    assert entries(server, to="2001-01-01") == [] and entries(server, project="default")
    for wrong, field in (
        ("action=nothing", "action"),
        ("from=yesterday", "from"),
        ("project=nowhere", "project"),
        ("f=jsonl&limit=3", "limit"),
        ("actor=" + "x" * 256, "actor"),
        ("after=abc", "after"),
    ):
        answer = server.get("/audit?" + wrong)
        assert answer.status == 422 and answer.json()["field"] == field, (wrong, answer)
    assert server.get("/audit?f=xml").status == 406


def test_nothing_secret_is_in_it(server):
    token = server.ok("POST", "/me/tokens", {"name": "nightly", "days": 1}).json()["secret"]
    text = json.dumps(lines(server))
    assert "nightly" in text
    for secret in (token, PASSWORD, "wrong and wrong"):
        assert secret not in text


def test_command_line(server):
    def audit(*options):
        return subprocess.run(
            [server.binary, "audit", "--data", server.data, *options],
            capture_output=True,
            text=True,
        )

    printed = audit("--action", "role_changed")
    assert printed.returncode == 0, printed
    found = [json.loads(line) for line in printed.stdout.splitlines()]
    assert found == entries(server, action="role_changed") and found, printed
    assert audit("--from", "2999-01-01").stdout == ""
    assert audit("--action", "nothing").returncode == 2
    assert audit("--from", "soon").returncode == 2


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
