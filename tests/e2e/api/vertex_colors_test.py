"""The mesh with the colors of its layers. Each vertex has the color of an unlit frame at its
position."""

import pytest
from support.cameras import camera_from
from support.colored_layers import make_colored_layers
from support.meshes import folded_grid
from support.pictures import pixels, png
from support.ply import read_ply
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
SIDE = 800


def times(matrix, vector):
    return [sum(matrix[4 * k + i] * vector[k] for k in range(4)) for i in range(4)]


def seen_colors(rows, camera, vertices):
    """Returns the color at each vertex's pixel. Omits vertices near an edge between colors, where a
    frame mixes them."""
    seen = {}
    for i, vertex in enumerate(vertices):
        x, y, _, w = times(
            camera["projection"], times(camera["view"], [vertex["x"], vertex["y"], vertex["z"], 1])
        )
        column, row = int((x / w + 1) / 2 * SIDE), int((1 - y / w) / 2 * SIDE)
        around = [rows[row + dy][column + dx] for dy in range(-3, 4) for dx in range(-3, 4)]
        if all(abs(a - b) <= 2 for each in around for a, b in zip(each, around[24])):
            seen[i] = around[24]
    return seen


def check_as_seen(server, query, at_least, kinds, **frame):
    """`kinds` is the least number of different colors that makes the comparison useful."""
    camera = camera_from(server.get(M).json(), (0, 0, 1), SIDE, SIDE, up=(0, 1, 0))
    answer = server.ok(
        "POST",
        M + "/frame",
        {"camera": camera, "light": {"mode": "unlit"}, "format": "png", **frame},
    )
    vertices, _, names = read_ply(server.ok("GET", f"{M}/vertices.ply?{query}").body)
    assert names[3:6] == ["red", "green", "blue"], names
    seen = seen_colors(pixels(answer.body), camera, vertices)
    for i, color in seen.items():
        mine = [vertices[i][name] for name in ("red", "green", "blue")]
        assert all(abs(a - b) <= 3 for a, b in zip(mine, color)), (vertices[i], color)
    assert len(seen) >= at_least and len(set(seen.values())) >= kinds, (
        len(seen),
        set(seen.values()),
    )


def make_layers(server):
    make_colored_layers(server, M)
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Pieces", "columns": [{"name": "Code"}, {"name": "State"}]},
    )
    for state in ("loose", "firm"):
        server.ok("POST", "/tables/pieces/records", {"values": {"code": state, "state": state}})
    by_state = {
        "mode": "categorical",
        "column": "state",
        "points": [{"at": 0, "value": "loose", "color": "#00ff00"}],
        "others": "#ff00ff",
    }
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Pieces",
            "kind": "database",
            "type": "u16",
            "table": "pieces",
            "resolution": 2048,
            "palette": by_state,
        },
    )
    dab(server, f"{M}/layers/pieces", 1, 20, 20, 12)
    dab(server, f"{M}/layers/pieces", 2, 60, 60, 12)


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(cells=40, fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    make_layers(server)
    return server


def test_colours_are_those_that_are_seen(server):
    assert read_ply(server.get(M + "/vertices.ply?layers=wet").body)[2][3:] == [
        "wet",
        "wet_valid",
    ], "without `colors` as before"
    assert (
        server.get(M + "/vertices.ply?colors=scan&layers=wet").body
        == server.get(M + "/vertices.ply?layers=wet").body
    )
    check_as_seen(server, "colors=layers", 500, 6)


def test_layers_that_are_named_are_drawn_in_their_order(server):
    # The requested layers are drawn in the requested order, visible or not.
    server.ok("PATCH", M + "/layers/wet", {"visible": False})
    check_as_seen(server, "colors=layers", 500, 5)
    check_as_seen(server, "colors=layers&layers=units,wet", 500, 3, layers=["units", "wet"])
    check_as_seen(server, "colors=layers&layers=wet,units", 500, 4, layers=["wet", "units"])
    check_as_seen(server, "colors=layers&at=2", 500, 2, at=2)


def test_photos_lie_below(server):
    photo = png(64, 64, lambda x, y: (240, 120, 0, 255) if x < 32 else (0, 120, 240, 128))
    server.ok(
        "POST",
        M + "/looks?name=Light&visible=true",
        photo,
        headers={"Content-Type": "image/png"},
    )
    check_as_seen(server, "colors=layers", 400, 6)
    server.ok("PATCH", M + "/looks/light", {"opacity": 0.25})
    check_as_seen(server, "colors=layers", 400, 6)


def test_wrong_questions_are_refused(server):
    for query, status, field in (
        ("colors=rainbow", 422, "colors"),
        ("colors=", 422, "colors"),
        ("colors=layers&layers=nothing", 404, "layers"),
        ("colors=layers&at=99999", 422, "at"),
    ):
        answer = server.get(f"{M}/vertices.ply?{query}")
        assert (answer.status, answer.json()["field"]) == (status, field), (query, answer)
    broken = {"mode": "categorical", "column": "nothing"}
    server.ok("PATCH", M + "/layers/pieces", {"palette": broken})
    answer = server.get(M + "/vertices.ply?colors=layers")
    assert (answer.status, answer.json()["field"]) == (422, "palette.column"), answer


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
