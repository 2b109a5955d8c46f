"""Saved views over HTTP: their content, the rights to change them, the rest of a view after its
layers were deleted, events, and refusals."""
import struct
import uuid

import pytest
from support.cameras import camera_from
from support.live_client import LiveClient
from support.meshes import folded_grid

M = "/models/sheet"
ALL = M + "/views"


def told(answer, status, field=None):
    assert answer.status == status, answer
    problem = answer.json()
    assert problem["detail"] and (field is None or problem.get("field") == field), problem
    return problem


@pytest.fixture(scope="module")
def model(server):
    return server.import_model(folded_grid(), "sheet.ply", name="Sheet", unit="mm")


@pytest.fixture(scope="module")
def camera(model):
    return {**camera_from(model, (0.3, 0.2, 1)), "section": [[1, 0, 0, -20]]}


@pytest.fixture(scope="module", autouse=True)
def layer_of(server, model):
    layer_of = {}
    for name, more in (
        ("Cracks", {"type": "u8"}),
        (
            "Units",
            {"type": "u16", "kind": "database", "columns": [{"name": "State", "kind": "text"}]},
        ),
    ):
        layer_of[name] = server.ok(
            "POST", M + "/layers", {"name": name, "resolution": 2048, **more}
        ).json()["id"]
    return layer_of


@pytest.fixture(scope="module")
def tokens(server):
    return {
        name: server.add_person(name, role)
        for name, role in (
            ("vera", "viewer"),
            ("ada", "annotator"),
            ("bob", "annotator"),
            ("carl", "curator"),
        )
    }


@pytest.fixture(scope="module")
def ask(server, tokens):
    def ask(who, method, path, body=None, **more):
        return server.request(method, path, body, token=tokens[who], **more)

    return ask


@pytest.fixture(scope="module")
def palette():
    return {
        "mode": "categorical",
        "points": [{"at": 3, "color": "#d55e00", "label": "Crack"}],
    }


@pytest.fixture(scope="module")
def shown(camera, palette):
    """Returns the content of a saved view."""
    return {
        "camera": camera,
        "light": {"mode": "raking", "direction": [1, 0.5, 0.25]},
        "layers": [
            {"layer": "cracks", "visible": True, "opacity": 0.25, "palette": palette},
            {
                "layer": "units",
                "visible": False,
                "highlight": {"filter": "state = 'loose'", "isolate": True},
            },
        ],
        "looks": [],
    }


def test_a_view_keeps_what_is_shown(server, ask, layer_of, shown, story):
    with LiveClient(server, "sheet") as live:
        live.hello()
        made = ask(
            "ada",
            "POST",
            ALL,
            {"name": "Westwand, größer", "text": "Flaking\nof 2019", **shown},
        )
        assert made.status == 201, made
        view = story.view = made.json()
        event = live.receive_until("view")
        assert event == {
            "op": "view",
            "event": "created",
            "view": view["id"],
            "user": "ada",
        }, event
    slug = story.slug = view["slug"]
    assert (
        made.headers["Location"] == f"/api/v1{ALL}/{slug}" and made.headers["ETag"] == '"v1"'
    ), made.headers
    assert (
        view["user"] == "ada"
        and view["name"] == "Westwand, größer"
        and view["text"] == "Flaking\nof 2019"
    )
    for number, name in enumerate(("Cracks", "Units")):  # the same layers, by their ids
        shown["layers"][number]["layer"] = layer_of[name]
    assert {part: view[part] for part in shown} == shown, view


def test_everybody_reads_them(server, ask, tokens, camera, story):
    """Views are found by slug and by id. A second view with the same name gets another slug."""
    view = story.view
    slug = story.slug
    for who in tokens:
        assert ask(who, "GET", ALL).json() == {"views": [view], "total": 1}
        assert (
            ask(who, "GET", f"{ALL}/{view['id']}").json()
            == ask(who, "GET", f"{ALL}/{slug}").json()
            == view
        )
    tag = ask("vera", "GET", f"{ALL}/{slug}").headers["ETag"]
    assert ask("vera", "GET", f"{ALL}/{slug}", headers={"If-None-Match": tag}).status == 304
    told(ask("vera", "POST", ALL, {"name": "Mine", "camera": camera}), 403)
    key = {"Idempotency-Key": str(uuid.uuid4())}
    second = story.second = ask(
        "bob", "POST", ALL, {"name": view["name"], "camera": camera}, headers=key
    ).json()
    assert (
        ask("bob", "POST", ALL, {"name": view["name"], "camera": camera}, headers=key).json()
        == second
    )
    assert (
        second["slug"] == slug + "-2"
        and second["layers"] == []
        and "looks" not in second
        and second["light"]["mode"] == "museum"
    ), second
    page = server.get(ALL + "?limit=1&offset=1")
    assert (
        page.json()["views"] == [second]
        and page.json()["total"] == 2
        and 'rel="prev"' in page.headers["Link"]
    ), page


def test_who_made_one_and_curators_change_it(ask, model, story):
    """The slug of a view does not change."""
    view = story.view
    slug = story.slug
    told(ask("bob", "PATCH", f"{ALL}/{slug}", {"name": "Bob's"}), 403)
    told(ask("bob", "DELETE", f"{ALL}/{slug}"), 403)
    told(ask("vera", "DELETE", f"{ALL}/{slug}"), 403)
    named = ask(
        "ada", "PATCH", f"{ALL}/{slug}", {"name": "East"}, headers={"If-Match": '"v1"'}
    ).json()
    assert named == {**view, "name": "East", "version": 2}, named
    told(
        ask("carl", "PATCH", f"{ALL}/{slug}", {"name": "North"}, headers={"If-Match": '"v1"'}),
        412,
    )
    other = camera_from(model, (-0.3, 0.1, 1))
    turned = ask("carl", "PATCH", f"{ALL}/{slug}", {"camera": other}).json()
    assert (
        turned["camera"] == other
        and turned["layers"] == []
        and turned["name"] == "East"
        and turned["user"] == "ada"
    ), turned


def test_what_cannot_be_shown_is_refused_and_named(server, ask, camera, story):
    slug = story.slug
    singular = {**camera, "view": [0] * 16}
    for body, field in (
        ({"camera": singular}, "camera.view"),
        ({"camera": {**camera, "width": 0}}, "camera.width"),
        ({"layers": [{"layer": "cracks"}, {"layer": "nothing"}]}, "layers[1].layer"),
        ({"layers": [{"layer": "cracks", "opacity": 2}]}, "layers[0].opacity"),
        ({"layers": [{"layer": "cracks", "highlight": {"keys": [1]}}]}, "layers[0].highlight"),
        (
            {"layers": [{"layer": "units", "highlight": {"filter": "state = "}}]},
            "layers[0].highlight.filter",
        ),
        ({"looks": [{"look": "infrared"}]}, "looks[0].look"),
        ({"light": {"mode": "moon"}}, "light.mode"),
        ({"name": ""}, "name"),
        ({"name": "a\u0000b"}, None),
        ({"text": "x" * 10_001}, "text"),
        ({"nothing": 1}, None),
    ):
        answer = ask("ada", "POST", ALL, {"name": "Bad", "camera": camera, **body})
        assert answer.status in (400, 404, 422), answer
        assert field is None or answer.json().get("field") == field, (body, answer)
    told(ask("ada", "PATCH", f"{ALL}/{slug}", {"layers": []}), 422)
    told(server.get(f"{ALL}/nothing"), 404)
    told(server.get("/models/nothing/views"), 404)
    assert server.get(ALL).json()["total"] == 2


def test_a_picture_is_what_the_view_keeps(server, ask, camera, palette):
    """The picture equals the frame of a model with these defaults."""
    light = {"mode": "raking", "direction": [1, 0.5, 0.25]}
    server.ok(
        "POST",
        M + "/layers/cracks/edits",
        {"op": "fill", "mode": "where", "where": "true", "value": 3},
    )
    own = {"opacity": 0.25, "palette": palette}
    view = ask(
        "ada",
        "POST",
        ALL,
        {
            "name": "Pictured",
            "camera": camera,
            "light": light,
            "looks": [],
            "layers": [
                {"layer": "cracks", "visible": True, **own},
                {"layer": "units", "visible": False},
            ],
        },
    ).json()
    path = f"{ALL}/{view['slug']}"

    def frame(**more):
        return server.ok(
            "POST",
            M + "/frame",
            {
                "camera": camera,
                "light": light,
                "looks": [],
                "samples": 16,  # the number for a view's picture
                "format": "png",
                **more,
            },
        ).body

    def picture(who="vera", query="?format=png"):
        answer = ask(who, "GET", path + "/picture" + query)
        assert answer.status == 200, answer
        return answer.body

    def size(png):
        return struct.unpack(">II", png[16:24])

    was = server.get(M + "/layers/cracks").json()
    before = frame()
    shown = picture()
    assert shown != before and size(shown) == (camera["width"], camera["height"])
    server.ok("PATCH", M + "/layers/cracks", own)
    server.ok("PATCH", M + "/layers/units", {"visible": False})
    assert frame() == shown == picture()
    server.ok(
        "PATCH",
        M + "/layers/cracks",
        {"opacity": was["opacity"], "palette": was["palette"], "visible": False},
    )
    server.ok("PATCH", M + "/layers/units", {"visible": True})
    assert (
        frame() == frame(layers=["units"]) and picture() == shown
    ), "what the view keeps comes before the defaults"

    small = size(picture(query="?format=png&thumbnail=100"))
    assert (
        max(small) == 100 and abs(small[0] / small[1] - camera["width"] / camera["height"]) < 0.02
    ), small
    jpeg = ask("vera", "GET", path + "/picture?thumbnail=64")
    assert jpeg.headers["Content-Type"] == "image/jpeg" and jpeg.body[:2] == b"\xff\xd8", jpeg
    for query, field in (
        ("?thumbnail=8", "thumbnail"),
        ("?thumbnail=1025", "thumbnail"),
        ("?thumbnail=x", "thumbnail"),
        ("?format=gif", "format"),
    ):
        told(ask("vera", "GET", path + "/picture" + query), 422, field)
    told(server.get(f"{ALL}/nothing/picture"), 404)

    server.ok("PATCH", M + "/layers/cracks", {"visibility": "private", "visible": True})
    assert (
        picture() == frame(layers=[]) and picture("carl") == shown
    ), "who does not see a layer does not see it in a view"
    server.ok("PATCH", M + "/layers/cracks", {"visibility": "public"})
    assert ask("ada", "DELETE", path).status == 204


def test_what_names_a_column_of_others_is_left_out(server, ask, layer_of, shown, story):
    """A column that does not exist is also omitted."""
    slug = story.slug
    server.ok("PATCH", "/tables/units/columns/state", {"visibility": "private"})
    back = ask(
        "ada",
        "PATCH",
        f"{ALL}/{slug}",
        {key: shown[key] for key in ("camera", "light", "layers", "looks")},
    ).json()
    assert "highlight" not in back["layers"][1] and "palette" in back["layers"][0], back
    assert ask("carl", "GET", f"{ALL}/{slug}").json()["layers"][1] == shown["layers"][1]
    server.ok("PATCH", M + "/layers/cracks", {"visibility": "private"})
    assert [each["layer"] for each in ask("vera", "GET", f"{ALL}/{slug}").json()["layers"]] == [
        layer_of["Units"]
    ]
    assert len(ask("carl", "GET", ALL).json()["views"][0]["layers"]) == 2
    for of, now in (
        (M + "/layers/cracks", "public"),
        ("/tables/units/columns/state", "public"),
    ):
        server.ok("PATCH", of, {"visibility": now})


def test_a_layer_that_goes_is_left_out(server, ask, layer_of, shown, story):
    slug = story.slug
    back = ask(
        "ada",
        "PATCH",
        f"{ALL}/{slug}",
        {key: shown[key] for key in ("camera", "light", "layers", "looks")},
    ).json()
    assert [each["layer"] for each in back["layers"]] == list(layer_of.values())
    server.ok("DELETE", M + "/layers/cracks")
    assert [each["layer"] for each in server.get(f"{ALL}/{slug}").json()["layers"]] == [
        layer_of["Units"]
    ]


def test_over_a_restart_and_who_is_deleted_leaves_no_name(server, ask, story):
    slug = story.slug
    second = story.second
    assert server.stop() == 0
    server.start()
    assert ask("bob", "DELETE", f"{ALL}/{second['slug']}").status == 204
    told(server.get(f"{ALL}/{second['id']}"), 404)
    server.ok("DELETE", "/users/ada")
    assert server.get(f"{ALL}/{slug}").json()["user"].startswith("former-")
    server.assert_clean_log()
