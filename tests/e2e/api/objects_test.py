"""Objects with dated surveys over HTTP: roles, visibility, messages to open pages, imports with the
command line, and refusals."""
import json
import subprocess

import pytest
from support.live_client import LiveClient
from support.meshes import folded_grid
from support.strata_server import LONG_S

ALL = "/projects/default/objects"


def ply():
    return folded_grid(fold=0.001)


@pytest.fixture(scope="module")
def server(server):
    for year in ("2019", "2022"):
        server.import_model(ply(), "bust.ply", name="Bust " + year, unit="mm", resolution=2048)
    return server


@pytest.fixture(scope="module")
def tokens(server):
    return {
        name: server.add_person(name, role)
        for name, role in (("vera", "viewer"), ("ada", "annotator"), ("carl", "curator"))
    }


@pytest.fixture(scope="module")
def ask(server, tokens):
    return lambda who, method, path, body=None: server.request(
        method, path, body, token=tokens[who]
    )


@pytest.fixture(scope="module")
def bust(ask):
    made = ask("carl", "POST", ALL, {"name": "Bust"})
    assert made.status == 201, made
    assert made.headers["Location"] == f"/api/v1{ALL}/{made.json()['id']}"
    assert made.json()["surveys"] == []
    return made.json()["id"]


def dates(answer):
    return [(each["date"], each["slug"]) for each in answer.json()["surveys"]]


def test_only_curators_change_objects(ask, bust):
    for who in ("vera", "ada"):
        assert ask(who, "POST", ALL, {"name": "Torso"}).status == 403
        assert ask(who, "PATCH", f"{ALL}/{bust}", {"name": "Torso"}).status == 403
        assert ask(who, "DELETE", f"{ALL}/{bust}").status == 403
        put = {"object": bust, "survey_date": "2019"}
        assert ask(who, "PATCH", "/models/bust-2019", put).status == 403
        assert ask(who, "GET", f"{ALL}/{bust}").json()["name"] == "Bust"


def test_a_change_of_a_model_puts_it_into_an_object_and_reaches_open_pages(server, ask, bust):
    with LiveClient(server, "bust-2022") as other:
        other.hello()
        put = {"object": bust, "survey_date": "2022-06"}
        now = ask("carl", "PATCH", "/models/bust-2022", put).json()
        assert now["object"] == bust and now["survey_date"] == "2022-06"
        assert other.receive_until("model")["model"]["object"] == bust
    ask("carl", "PATCH", "/models/bust-2019", {"object": bust, "survey_date": "2019-05-01"})
    expected = [("2019-05-01", "bust-2019"), ("2022-06", "bust-2022")]
    assert dates(ask("vera", "GET", f"{ALL}/{bust}")) == expected
    listed = ask("vera", "GET", ALL).json()
    assert listed["total"] == 1 and listed["objects"][0]["id"] == bust


def test_the_activity_names_the_change(ask):
    lines = ask("vera", "GET", "/projects/default/activity").json()["activity"]
    changed = [each for each in lines if each["kind"] == "model" and each["op"] == "changed"]
    assert {"object_id", "survey_date"} <= set(changed[0]["changed"]), changed


def test_the_date_changes_alone_and_other_changes_keep_it(server, ask, bust):
    now = server.ok("PATCH", "/models/bust-2019", {"survey_date": "2019"}).json()
    assert (now["object"], now["survey_date"]) == (bust, "2019")
    now = server.ok("PATCH", "/models/bust-2019", {"credit": "Museum"}).json()
    assert (now["object"], now["survey_date"]) == (bust, "2019")


@pytest.mark.parametrize(
    "body, field",
    [
        ({"survey_date": "2019-13"}, "survey_date"),
        ({"survey_date": "2019-02-30"}, "survey_date"),
        ({"survey_date": "May 2019"}, "survey_date"),
        ({"survey_date": ""}, "survey_date"),
        ({"object": 0, "survey_date": "2019"}, "object"),
        ({"object": 999, "survey_date": "2019"}, "object"),
        ({"object": -1}, "object"),
        ({"object": "Bust"}, "object"),
    ],
)
def test_a_bad_survey_is_refused(server, body, field):
    before = server.get("/models/bust-2019").json()
    answer = server.request("PATCH", "/models/bust-2019", body)
    assert answer.status in (400, 422) and answer.json()["field"] == field, answer
    assert server.get("/models/bust-2019").json() == before


def test_a_guest_sees_no_object_of_another_project(server, bust):
    server.ok("POST", "/projects", {"name": "Villa"})
    guest = server.add_person("gus", "guest")
    server.ok("PUT", "/projects/villa/members/gus", {"role": "curator"})
    for method, path in (("GET", ALL), ("GET", f"{ALL}/{bust}"), ("DELETE", f"{ALL}/{bust}")):
        assert server.request(method, path, token=guest).status == 404
    assert server.request("GET", f"/projects/villa/objects/{bust}", token=guest).status == 404


def test_an_object_with_surveys_is_not_deleted(server, ask, bust):
    refused = ask("carl", "DELETE", f"{ALL}/{bust}")
    assert refused.status == 409 and "2 surveys" in refused.json()["detail"], refused


def test_names_are_unique_and_can_change(ask, bust):
    other = ask("carl", "POST", ALL, {"name": "Torso"}).json()["id"]
    assert ask("carl", "POST", ALL, {"name": "BUST"}).status == 409
    assert ask("carl", "PATCH", f"{ALL}/{other}", {"name": "bust"}).status == 409
    for name in ("", "x" * 201, 4):
        assert ask("carl", "POST", ALL, {"name": name}).json()["field"] == "name"
    assert ask("carl", "PATCH", f"{ALL}/{other}", {"name": "Head"}).json()["name"] == "Head"
    assert ask("carl", "DELETE", f"{ALL}/{other}").status == 204
    assert ask("carl", "GET", f"{ALL}/{other}").status == 404


def test_an_import_names_the_object(server, bust, tmp_path):
    scan = tmp_path / "bust.ply"
    scan.write_bytes(ply())
    words = [server.binary, "import", scan, "--server", server.url, "--token", server.token]
    words += ["--name", "Bust 2025", "--unit", "mm", "--object", "bust", "--survey", "2025"]
    ran = subprocess.run(words, capture_output=True, text=True, check=False, timeout=LONG_S)
    assert ran.returncode == 0, ran.stderr
    model = json.loads(ran.stdout)
    assert (model["object"], model["survey_date"]) == (bust, "2025"), model
    new = server.import_model(
        ply(), "coin.ply", name="Coin", unit="mm", object="Coin", survey_date="2025-01"
    )
    names = {each["id"]: each["name"] for each in server.get(ALL).json()["objects"]}
    assert names[new["object"]] == "Coin"
    refused = server.request("POST", "/models?filename=x.ply&object=Bust", ply())
    assert refused.status == 422 and refused.json()["field"] == "survey_date", refused


def test_a_model_leaves_its_object(server, bust):
    now = server.ok("PATCH", "/models/bust-2025", {"object": 0}).json()
    assert "object" not in now and "survey_date" not in now
    server.ok("DELETE", "/models/bust-2019")
    assert dates(server.get(f"{ALL}/{bust}")) == [("2022-06", "bust-2022")]
