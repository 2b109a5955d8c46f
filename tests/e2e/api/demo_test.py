"""The reset of the demo over HTTP: the right to request it, the original state of the pot, and the
unchanged rest of the project."""
import pytest
from support.kiosk_site import told
from support.meshes import folded_grid
from support.strata_server import StrataServer

POT = "/models/demo-pot"


@pytest.fixture(scope="module")
def server():
    with StrataServer(demo=True) as started:
        yield started


def test_only_administrators_reset_it(server):
    told(server.post("/demo/reset", token=server.add_person("carl", "curator")), 403)
    told(server.post("/demo/reset?again=1"), 400, "again")


def test_the_pot_is_as_at_first_and_the_rest_stays(server):
    project = server.get(POT).json()["project"]
    other = server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", project=project)
    server.ok("POST", POT + "/layers", {"name": "Mine", "type": "u8"})
    fill = {"op": "fill", "mode": "where", "where": "true", "value": 1}
    server.ok("POST", POT + "/layers/mine/edits", fill)
    before = server.get(POT).json()["id"]
    for _ in range(2):  # in the second round there is a history to erase
        job = server.ok("POST", "/demo/reset").json()["id"]
        ended = server.wait_for_job(job)
        assert ended["state"] == "done", ended
    pot = server.get(POT).json()
    assert pot["id"] > before and pot["project"] == project
    layers = {layer["slug"] for layer in server.get(POT + "/layers").json()["layers"]}
    assert "mine" not in layers and {"condition", "observations", "measures"} <= layers
    assert server.get(f"/models/{other['id']}").json()["name"] == "Sheet"
    edits = server.get(POT + "/layers/condition/edits").json()["edits"]
    assert {"lena.demo"} == {edit["user"] for edit in edits}


def test_a_site_without_the_demo_has_nothing_to_reset():
    with StrataServer() as empty:
        told(empty.post("/demo/reset"), 404)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
