"""Groups of layers: created, changed, removed, sent to open pages, and set by templates. The file
also tests the blending mode of layers."""
import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid

M = "/models/sheet"
L = M + "/layers"


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    server.ok("POST", L, {"name": "Cracks", "type": "u8"})
    return server


def groups(server):
    return {each["slug"]: each.get("group") for each in server.get(L).json()["layers"]}


def test_a_layer_is_in_a_group_without_blanks_at_its_ends(server):
    made = server.ok("POST", L, {"name": "Salts", "type": "u8", "group": "  North side "}).json()
    assert made["group"] == "North side"
    assert groups(server) == {"cracks": None, "salts": "North side"}


def test_a_change_reaches_open_pages_and_an_empty_text_removes_the_group(server):
    with LiveClient(server, "sheet") as other:
        other.hello()
        for sent, stored in (("Süden", "Süden"), ("x" * 60, "x" * 60), ("  ", None)):
            now = server.ok("PATCH", L + "/salts", {"group": sent}).json()
            assert now.get("group") == stored
            event = other.receive_until("layer")
            assert event["event"] == "changed" and event["layer"].get("group") == stored
    assert groups(server)["salts"] is None


def test_other_changes_keep_it(server):
    server.ok("PATCH", L + "/cracks", {"group": "Damage"})
    server.ok("PATCH", L + "/cracks", {"unit": "mm"})
    assert groups(server)["cracks"] == "Damage"


@pytest.mark.parametrize("group", ["x" * 61, 4, None, ["a"]])
def test_a_bad_group_is_refused(server, group):
    answer = server.request("PATCH", L + "/cracks", {"group": group})
    assert answer.status in (400, 422) and answer.json()["field"] == "group", answer
    assert groups(server)["cracks"] == "Damage"


def test_a_group_with_a_zero_character_is_refused(server):
    answer = server.request("PATCH", L + "/cracks", {"group": "a\0b"})
    assert answer.status in (400, 422), answer  # 400 if the server refuses the JSON text itself
    assert groups(server)["cracks"] == "Damage"


def test_the_blending_mode_changes_the_picture(server):
    assert "blend" not in server.get(L + "/cracks").json()
    camera = camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))
    palette = {"mode": "step", "min": 0, "max": 1, "points": [{"at": 0, "color": "#c08040ff"}]}
    server.ok("PATCH", L + "/cracks", {"palette": palette})
    stroke = {"op": "stroke", "value": 1, "camera": camera, "radius_px": 200, "path": [[320, 240]]}
    server.ok("POST", L + "/cracks/edits", stroke)

    def picture():
        body = {"camera": camera, "format": "png", "layers": ["cracks"]}
        return server.ok("POST", M + "/frame", body).body

    pictures = {"normal": picture()}
    for mode in ("multiply", "screen"):
        assert server.ok("PATCH", L + "/cracks", {"blend": mode}).json()["blend"] == mode
        pictures[mode] = picture()
    assert len(set(pictures.values())) == 3
    refused = server.request("PATCH", L + "/cracks", {"blend": "overlay"})
    assert refused.status in (400, 422) and refused.json()["field"] == "blend", refused
    now = server.ok("PATCH", L + "/cracks", {"blend": "normal"}).json()
    assert "blend" not in now and picture() == pictures["normal"]


def test_a_template_names_its_group_in_the_language_of_the_user(server):
    use = {"model": "sheet", "language": "de"}
    made = server.ok("POST", "/projects/default/templates/stone-condition", use).json()
    assert {layer["group"] for layer in made["layers"]} == {"Stein"}
    treatment = server.ok("POST", "/projects/default/templates/treatment", use).json()
    assert all("group" not in layer for layer in treatment["layers"])
