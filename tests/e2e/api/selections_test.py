"""Selections that are combined from several parts, grown and smoothed, over HTTP."""
import math

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
A = {"at": {"point": [40, 50, 0]}, "radius_mm": 15}  # two discs that overlap
B = {"at": {"point": [55, 50, 0]}, "radius_mm": 12}
DAMP = {"where": "moisture > 3"}


def parts(first, *others, **more):
    """Returns a combination of `first` with the pairs (combine, within) in `others`."""
    steps = [{"combine": how, "within": within} for how, within in others]
    return {"parts": [{"within": first}, *steps], **more}


def select(server, within, **more):
    return server.ok("POST", M + "/select", {"within": within, **more}).json()


def count(server, within):
    return select(server, within)["texels"]


def area_mm2(server, within):
    return select(server, within)["area_m2"] * 1e6


def refused(server, within, field, status=422, **more):
    answer = server.post(M + "/select", {"within": within, **more})
    assert answer.status == status and answer.json()["field"] == field, answer
    return answer.json()


@pytest.fixture(scope="module")
def server(server):
    sheet = folded_grid(cells=200, fold=0.001)
    server.import_model(sheet, "sheet.ply", name="Sheet", unit="mm", resolution=2048)
    for name, kind in (("Damage", "u8"), ("Moisture", "f32"), ("Secret", "u8")):
        server.ok("POST", M + "/layers", {"name": name, "type": kind, "resolution": 2048})
    dab(server, M + "/layers/moisture", 5, 60, 60, 20)
    dab(server, M + "/layers/secret", 1, 50, 50, 10)
    server.ok("PATCH", M + "/layers/secret", {"visibility": "private"})
    return server


def test_counts_follow_the_algebra_of_sets(server):
    camera = camera_from(server.get(M).json(), (0, 0, 1), 640, 480, up=(0, 1, 0))
    outline = {"camera": camera, "path": [[250, 180], [400, 180], [400, 300], [250, 300]]}
    like = {
        "like": {"at": {"point": [60, 60, 0]}, "by": "value", "layer": "moisture", "tolerance": 0.5}
    }
    for one, other in ((A, B), (A, DAMP), (DAMP, outline), (outline, like), (like, A)):
        a, b = count(server, one), count(server, other)
        both = count(server, parts(one, ("intersect", other)))
        assert a + b == count(server, parts(one, ("add", other))) + both, (one, other)
        assert count(server, parts(one, ("subtract", other))) == a - both
        assert 0 < both < a, (one, other)


def test_parts_are_combined_in_their_order_and_can_be_nested(server):
    whole = {"where": "true"}
    assert count(server, parts(A, ("subtract", A), ("add", B))) == count(server, B)
    assert count(server, parts(A, ("add", B), ("subtract", A))) < count(server, B)
    # Intersections are distributive, and complements follow the law of De Morgan.
    assert count(server, parts(DAMP, ("intersect", parts(A, ("add", B))))) == count(
        server,
        parts(parts(DAMP, ("intersect", A)), ("add", parts(DAMP, ("intersect", B)))),
    )
    neither = parts(whole, ("subtract", parts(A, ("add", B))))
    assert count(server, neither) == count(
        server, parts(parts(whole, ("subtract", A)), ("intersect", parts(whole, ("subtract", B))))
    )
    assert count(server, parts(A)) == count(server, A)


def test_growth_on_a_plane_follows_the_formula(server):
    for grow in (5, 10, -5, -10):
        expected = math.pi * (15 + grow) ** 2
        found = area_mm2(server, {**A, "grow_mm": grow})
        assert abs(found - expected) < 0.03 * math.pi * 25**2, (grow, found, expected)
    assert count(server, {**A, "grow_mm": -20}) == 0
    assert select(server, {"where": "true", "grow_mm": -20})["share"] > 0.999
    assert select(server, {**A, "grow_mm": 1000})["share"] > 0.999
    # A disc is the same after it has grown and shrunk.
    back = area_mm2(server, parts({**A, "grow_mm": 8}, grow_mm=-8))
    assert abs(back - area_mm2(server, A)) < 0.02 * math.pi * 15**2
    # The growth comes after the combination.
    ring = parts({**A, "grow_mm": 5}, ("subtract", A))
    assert abs(area_mm2(server, ring) - math.pi * (20**2 - 15**2)) < 40


def test_smoothing_removes_narrow_pieces_and_closes_narrow_gaps(server):
    spot = {"at": {"point": [80, 20, 0]}, "radius_mm": 2}
    hole = {"at": {"point": [40, 50, 0]}, "radius_mm": 2}
    rough = parts(A, ("subtract", hole), ("add", spot))
    smooth = {**rough, "smooth_mm": 8}
    assert abs(area_mm2(server, smooth) - math.pi * 15**2) < 0.03 * math.pi * 15**2
    assert count(server, parts(smooth, ("intersect", spot))) == 0
    assert count(server, parts(hole, ("subtract", smooth))) == 0


def test_combinations_are_painted_measured_and_compared(server):
    ring = parts({**A, "grow_mm": 5}, ("subtract", A), ("intersect", {"where": "x > 40"}))
    done = select(server, ring, into={"layer": "damage", "value": 7}, layers=["moisture"])
    assert done["edit"]["texels_changed"] == done["texels"] > 0, done
    assert done["layers"]["moisture"]["texels"] <= done["texels"]
    assert count(server, {"where": "damage = 7"}) == done["texels"]
    table = server.ok(
        "POST", M + "/cross-table", {"rows": "damage", "columns": "damage", "within": ring}
    ).json()
    assert table["rows"] == [7], table
    server.ok("POST", M + "/layers/damage/undo")
    # The condition of a part reads the layer before it is painted.
    erased = parts(A, ("subtract", {"where": "valid(damage)"}))
    done = select(server, erased, into={"layer": "damage", "value": 8})
    assert done["edit"]["texels_changed"] == count(server, {"where": "damage = 8"})
    server.ok("POST", M + "/layers/damage/undo")


def test_painting_shows_only_what_all_users_of_the_layer_can_see(server):
    into = {"layer": "damage", "value": 1}
    hidden = {"where": "secret = 1"}
    refused(server, hidden, "within.where", into=into)
    refused(
        server,
        parts(A, ("intersect", parts(hidden))),
        "within.parts[1].within.parts[0].within.where",
        into=into,
    )
    like = {
        "like": {"at": {"point": [50, 50, 0]}, "by": "value", "layer": "secret", "tolerance": 0}
    }
    refused(server, parts(A, ("add", like)), "within.parts[1].within.like.layer", into=into)
    assert select(server, hidden, into={"layer": "secret", "value": 1})["edit"]
    assert count(server, hidden) > 0


def test_refusals(server):
    nested = A
    for _ in range(4):
        nested = parts(nested)
    assert count(server, nested) == count(server, A)
    refused(server, parts(nested), "within" + ".parts[0].within" * 4 + ".parts")
    many = parts(A, *[("add", A)] * 31)
    two = parts(many, ("add", many))
    assert count(server, two) == count(server, A)
    refused(server, parts(two, ("add", A)), "within.parts[1].within")
    for within, field in (
        ({"parts": [{"combine": "subtract", "within": A}]}, "within.parts[0].combine"),
        (parts({"where": "x >"}), "within.parts[0].within.where"),
        (parts(A, ("add", {"where": "nothing > 1"})), "within.parts[1].within.where"),
        (parts(A, ("add", {"at": {"point": [0, 0, 0]}})), "within.parts[1].within.radius_mm"),
        ({**A, "where": "true"}, "within.where"),
        ({**A, "grow_mm": 1001}, "within.grow_mm"),
        ({**A, "smooth_mm": 0}, "within.smooth_mm"),
        ({"parts": []}, "within.parts"),
    ):
        refused(server, within, field)
    refused(server, {"selection": "nothing"}, "within.selection", status=404)


def save(server, name, within, audience="everyone", **more):
    body = {"name": name, "within": within, "audience": audience}
    return server.ok("POST", M + "/selections", body, **more).json()


def test_a_saved_selection_is_used_by_its_name_and_follows_the_layers(server):
    made = save(server, "Damp part", parts(DAMP, ("subtract", A)))
    assert made["slug"] == "damp-part" and made["audience"] == "everyone", made
    by_name = {"selection": "damp-part"}
    assert count(server, by_name) == count(server, parts(DAMP, ("subtract", A)))
    assert count(server, {"selection": made["id"]}) == count(server, by_name)
    both = parts(A, ("add", by_name), grow_mm=2)
    assert count(server, both) == count(server, parts(A, ("add", DAMP), grow_mm=2))
    done = select(server, by_name, into={"layer": "damage", "value": 9})
    assert done["edit"]["texels_changed"] == done["texels"]
    server.ok("POST", M + "/layers/damage/undo")
    before = count(server, by_name)
    dab(server, M + "/layers/moisture", 6, 20, 20, 5)
    assert count(server, by_name) > before
    server.ok("POST", M + "/layers/moisture/undo")
    server.ok("PATCH", M + "/selections/damp-part", {"within": B})
    assert count(server, by_name) == count(server, B)
    server.ok("DELETE", M + "/selections/damp-part")
    refused(server, by_name, "within.selection", status=404)


def test_a_definition_is_checked_when_it_is_saved(server):
    one = save(server, "One", A)
    save(server, "Two", parts(A, ("add", {"selection": "one"})))
    answer = server.request("PATCH", M + "/selections/one", {"within": {"selection": "two"}})
    assert answer.status == 422 and answer.json()["title"] == "Selection uses itself", answer
    like = {
        "like": {"at": {"point": [50, 50, 0]}, "by": "value", "layer": "secret", "tolerance": 0}
    }
    for within in ({"where": "secret = 1"}, like, {"where": "nothing = 1"}, {"where": "x >"}):
        body = {"name": "Bad", "audience": "everyone", "within": within}
        answer = server.post(M + "/selections", body)
        assert answer.status == 422, answer
        assert answer.json()["field"].startswith("within"), answer
    mine = save(server, "Mine", {"where": "secret = 1"}, audience="personal")
    answer = server.request("PATCH", M + "/selections/mine", {"audience": "everyone"})
    assert answer.status == 422, answer
    body = {"name": "Bad", "audience": "everyone", "within": {"selection": "mine"}}
    assert server.post(M + "/selections", body).json()["field"] == "within.selection"
    refused(server, {"selection": "mine"}, "within.selection", into={"layer": "damage", "value": 1})
    many = save(server, "Many", parts(A, *[("add", A)] * 31))
    refused(
        server,
        parts({"selection": "many"}, ("add", {"selection": "many"}), ("add", A)),
        "within.parts[2].within",
    )
    for selection in ("two", one["slug"], mine["slug"], many["slug"]):
        server.ok("DELETE", f"{M}/selections/{selection}")


def test_nobody_else_sees_a_personal_selection(server):
    save(server, "My part", A, audience="personal")
    save(server, "Our part", B)
    vera = server.add_person("vera", "viewer")
    listed = server.get(M + "/selections", token=vera).json()
    assert [each["slug"] for each in listed["selections"]] == ["our-part"] and listed["total"] == 1
    assert server.get(M + "/selections/my-part", token=vera).status == 404

    def ask(name):
        return server.post(M + "/select", {"within": {"selection": name}}, token=vera)

    hidden, missing = ask("my-part"), ask("no-part")
    assert hidden.status == missing.status == 404
    assert hidden.json()["detail"].replace("my-part", "no-part") == missing.json()["detail"]
    assert ask("our-part").json()["texels"] == count(server, B)
    body = {"name": "Mine", "within": A}
    assert server.post(M + "/selections", body, token=vera).status == 403
    for selection in ("my-part", "our-part"):
        server.ok("DELETE", f"{M}/selections/{selection}")
