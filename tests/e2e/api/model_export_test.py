"""A model with its layers as a GLB or OBJ file for other programs."""
import math
import re
import struct

import numpy
import pytest
from support.colored_layers import make_colored_layers
from support.glb import Glb, pixel_at, read_png, validate
from support.meshes import bumpy_ball, folded_grid, ply
from support.obj import Obj
from support.pictures import png
from support.ply import read_ply
from support.readings import dab

M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm
IDENTIFIER = re.compile(r"^[a-zA-Z_][a-zA-Z0-9_]*$")
# notes of the validator about extensions that it does not know, and about what only these use
KNOWN_NOTES = {"UNSUPPORTED_EXTENSION", "UNUSED_OBJECT"}


def make_layers(server):
    make_colored_layers(server, M)
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Finds",
            "columns": [
                {"name": "Name", "unique": True},
                {"name": "2nd name"},
                {"name": "Depth", "kind": "numeric", "unit": "m"},
                {"name": "Loose", "kind": "boolean"},
                {"name": "Firm", "kind": "boolean", "required": True, "default": True},
                {"name": "State", "kind": "enumeration", "choices": ["good", "poor", "-"]},
                {"name": "Never"},
                {"name": "Price", "kind": "integer", "visibility": "private"},
            ],
        },
    )
    records = [{"name": f"Find {i}", "price": 1000 + i} for i in range(1, 301)]
    records[0].update({"depth": 0.25, "loose": True, "state": "poor", "2nd-name": "Tür"})
    records[1].update({"depth": -3, "firm": False})
    for values in records:
        server.ok("POST", "/tables/finds/records", {"values": values})
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Finds",
            "kind": "database",
            "type": "u16",
            "table": "finds",
            "resolution": 2048,
        },
    )
    # more records than one channel of a picture can distinguish
    rows = [f"{x * 5.5 + 3},{y * 5.5 + 3},0,{1 + y * 17 + x}" for y in range(17) for x in range(17)]
    server.ok(
        "POST",
        f"{M}/layers/finds/readings?radius_mm=2",
        "x,y,z,value\n" + "\n".join(rows) + "\n",
        headers={"Content-Type": "text/csv"},
    )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(cells=40, fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    make_layers(server)
    return server


def export(server, model=M, token=True, **wish):
    answer = server.request("POST", model + "/exports", wish, token=token)
    assert answer.status == 200, answer
    kinds = {"glb": "model/gltf-binary", "obj": "application/zip"}
    kind = kinds[wish.get("format", "glb")]
    assert answer.headers["Content-Type"] == kind, answer.headers.items()
    return answer.body


def only(server, *slugs):
    """Returns settings in which only these layers are visible, in this order from the bottom."""
    layers = server.get(M + "/layers").json()["layers"]
    return [
        {
            "layer": layer["slug"],
            "visible": layer["slug"] in slugs,
            "order": slugs.index(layer["slug"]) if layer["slug"] in slugs else 100,
        }
        for layer in layers
    ]


def check_valid(content, folder, *extensions):
    """The validator finds no error, no warning, and no note other than those about extensions."""
    file = folder / "model.glb"
    file.write_bytes(content)
    report = validate(file)
    issues = report["issues"]
    assert issues["numErrors"] == 0 and issues["numWarnings"] == 0, issues
    codes = {each["code"] for each in issues["messages"]}
    assert codes <= KNOWN_NOTES, issues
    assert set(Glb(content).json.get("extensionsUsed", [])) == set(extensions)


def area_of(places, triangles):
    a, b, c = (places[triangles[:, k]] for k in range(3))
    return numpy.linalg.norm(numpy.cross(b - a, c - a), axis=1).sum() / 2


def vertex_lookup(vertices):
    """Returns the vertices of a PLY file by their position."""
    return {tuple(round(each[axis], 3) for axis in "xyz"): each for each in vertices}


def in_sheet(places):
    """Returns meters with y up in the world of the sheet: mm, +z up."""
    places = places * 1000
    return numpy.stack([places[:, 0], -places[:, 2], places[:, 1]], axis=1)


def in_model(glb):
    return in_sheet(glb.places())


def by_position(server, glb, query):
    """Yields each vertex of vertices.ply with its texture coordinates in the file: several at a seam
    of the atlas."""
    lookup = vertex_lookup(read_ply(server.ok("GET", f"{M}/vertices.ply?{query}").body)[0])
    found = {}
    for place, uv in zip(in_model(glb), glb.attribute("TEXCOORD_0")):
        found.setdefault(tuple(round(float(each), 3) for each in place), []).append(uv)
    assert found.keys() == lookup.keys()
    for place, uvs in found.items():
        yield lookup[place], uvs


def around(image, uv):
    """Returns the colors of the pixels around the texture coordinates."""
    side = len(image)
    column, row = (min(side - 3, max(2, int(each * side))) for each in uv)
    return image[row - 2 : row + 3, column - 2 : column + 3, :3].reshape(-1, 3).astype(int)


def check_colors(server, query, at_least, **wish):
    """The texture has the colors of vertices.ply at all vertices. Both look up photos and texels, at
    the vertex and at the center of the pixel. So they differ only next to an edge between colors,
    and the comparison leaves out these vertices."""
    glb = Glb(export(server, texture_format="png", texture_size=2048, **wish))
    image = read_png(glb.color_image())
    assert image.shape == (2048, 2048, 4) and (image[:, :, 3] == 255).all()
    compared, kinds = 0, set()
    for vertex, uvs in by_position(server, glb, query):
        near = numpy.concatenate([around(image, uv) for uv in uvs])
        if (near.max(axis=0) - near.min(axis=0)).max() > 2:
            continue
        color = [vertex[name] for name in ("red", "green", "blue")]
        assert abs(pixel_at(image, uvs[0])[:3].astype(int) - color).max() <= 2, (vertex, color)
        compared, kinds = compared + 1, kinds | {tuple(color)}
    assert compared >= at_least and len(kinds) >= 4, (compared, kinds)


def test_any_viewer_can_open_the_file(server, tmp_path):
    check_valid(export(server, texture_size=1024), tmp_path)
    check_valid(export(server, texture_format="png"), tmp_path)
    unlit = export(server, unlit=True, texture_size=512, layers=only(server))
    check_valid(unlit, tmp_path, "KHR_materials_unlit")
    material = Glb(unlit).material()["pbrMetallicRoughness"]
    assert (material["metallicFactor"], material["roughnessFactor"]) == (0, 1), material


def test_the_texture_shows_the_colours_of_the_layers(server):
    check_colors(server, "colors=layers", 1000)
    check_colors(
        server, "colors=layers&layers=units,wet", 1000, layers=only(server, "units", "wet")
    )
    server.ok("PATCH", M + "/layers/wet", {"visible": False})
    sequence = int(server.get(M + "/layers/units/statistics").headers["Strata-Sequence"])
    dab(server, f"{M}/layers/units", 1, 20, 20, 15)
    check_colors(server, "colors=layers", 1000)
    check_colors(server, f"colors=layers&at={sequence}", 1000, at=sequence)
    server.ok("PATCH", M + "/layers/wet", {"visible": True})


def test_photos_are_below_the_layers(server):
    photo = png(64, 64, lambda x, y: (240, 120, 0, 255) if x < 32 else (0, 120, 240, 128))
    server.ok(
        "POST",
        M + "/looks?name=Light&visible=true",
        photo,
        headers={"Content-Type": "image/png"},
    )
    check_colors(server, "colors=layers", 800)
    server.ok("DELETE", M + "/looks/light")


def vertex_colors(server, model, query=""):
    """Returns the positions and colors of the vertices."""
    vertices = read_ply(server.ok("GET", f"{model}/vertices.ply?colors=layers{query}").body)[0]
    places = [[each[axis] for axis in "xyz"] for each in vertices]
    colors = [[each[name] for name in ("red", "green", "blue")] for each in vertices]
    return numpy.array(places, float), numpy.array(colors, int)


def compare_colors(server, places, colors, at_least):
    """The colors at these places on the sheet are those of the layer `units` at the vertices around
    them. Leaves out places where these vertices have different colors."""
    given_places, given_colors = vertex_colors(server, M, "&layers=units")
    compared, kinds = 0, set()
    for place, color in zip(places, colors):
        near = given_colors[numpy.linalg.norm(given_places - place, axis=1) < 4]
        if (near.max(axis=0) - near.min(axis=0)).max() > 2:
            continue
        assert abs(near[0] - color).max() <= 3, (place, near[0], color)
        compared, kinds = compared + 1, kinds | {tuple(near[0])}
    assert compared >= at_least and len(kinds) >= 2, (compared, kinds)


def test_pixels_between_the_charts_continue_the_colors(server):
    """Linear filters add no other color at the seams of a ball of one color."""
    server.import_model(bumpy_ball(), "ball.ply", name="Ball", unit="mm")
    palette = {"mode": "categorical", "points": [{"at": 1, "color": "#20c060"}]}
    server.ok(
        "POST",
        "/models/ball/layers",
        {"name": "Cover", "type": "u8", "resolution": 2048, "palette": palette},
    )
    fill = {"op": "fill", "mode": "where", "where": "true", "value": 1}
    server.ok("POST", "/models/ball/layers/cover/edits", fill)
    glb = Glb(export(server, "/models/ball", texture_format="png", texture_size=1024))
    image = read_png(glb.color_image())
    assert (image == [0x20, 0xC0, 0x60, 255]).all(), numpy.unique(image.reshape(-1, 4), axis=0)


@pytest.mark.parametrize("file_format,ending", [("glb", "glb"), ("obj", "zip")])
@pytest.mark.parametrize("name,up", [("sheet", "z"), ("ball", "y")])
def test_the_file_is_the_same_surface_when_imported_again(server, name, up, file_format, ending):
    server.ok("PATCH", f"/models/{name}", {"up": up})
    model = server.get(f"/models/{name}").json()
    content = export(server, f"/models/{name}", texture_size=512, format=file_format)
    again = f"{name}-{file_format}-again"
    server.import_model(content, f"model.{ending}", name=again)
    other = server.get(f"/models/{again}").json()
    assert other["triangles"] == model["triangles"], (model, other)
    assert other["area_m2"] == pytest.approx(model["area_m2"], rel=1e-5), (model, other)
    lowest, highest = ([each / 1000 for each in model["bounds"][end]] for end in ("min", "max"))
    if up == "z":
        lowest, highest = (
            [lowest[0], lowest[2], -highest[1]],
            [highest[0], highest[2], -lowest[1]],
        )
    assert other["bounds"]["min"] == pytest.approx(lowest, abs=1e-6), (model, other)
    assert other["bounds"]["max"] == pytest.approx(highest, abs=1e-6), (model, other)
    if file_format == "glb":
        glb = Glb(content)
        places, triangles = glb.places(), glb.triangles()
    else:
        obj = Obj(content)
        places, triangles = obj.places, obj.corners[:, :, 0]
    assert area_of(places, triangles) == pytest.approx(model["area_m2"], rel=1e-5)


def test_an_obj_file_is_the_same_surface_as_a_glb_file(server):
    wish = {"texture_size": 512, "texture_format": "png"}
    glb = Glb(export(server, **wish))
    obj = Obj(export(server, format="obj", unlit=True, **wish))
    assert (obj.name, obj.material["illum"]) == ("sheet", "0"), obj.material
    assert (read_png(obj.image) == read_png(glb.color_image())).all()
    assert 'model: "Sheet"' in obj.comments, obj.comments
    corners = glb.triangles().reshape(-1)
    numbers = obj.corners.reshape(-1, 3)
    assert abs(obj.places[numbers[:, 0]] - glb.places()[corners]).max() < 1e-8
    uvs = glb.attribute("TEXCOORD_0")[corners]
    uvs = numpy.stack([uvs[:, 0], 1 - uvs[:, 1]], axis=1)
    assert abs(obj.uvs[numbers[:, 1]] - uvs).max() < 1e-6
    # The normals of GLB are in the axes of the model.
    normals = glb.attribute("NORMAL")[corners]
    turned = numpy.stack([normals[:, 0], normals[:, 2], -normals[:, 1]], axis=1)
    assert abs(obj.normals[numbers[:, 2]] - turned).max() < 1e-4
    # A position is shared by all triangles around it, also at the seams of the atlas.
    assert len(obj.places) == len({tuple(each) for each in obj.places}) == 41 * 41


def test_an_obj_file_has_the_same_colors_when_imported_again(server):
    content = export(
        server, format="obj", texture_format="png", texture_size=2048, layers=only(server, "units")
    )
    server.import_model(content, "model.zip", name="Colored")
    found = vertex_colors(server, "/models/colored")
    compare_colors(server, in_sheet(found[0]), found[1], 1000)


def test_a_reduced_mesh_has_the_number_of_triangles_and_the_same_texture(server, tmp_path):
    model = server.get(M).json()
    wish = {"texture_format": "png", "texture_size": 2048, "layers": only(server, "units")}
    full = Glb(export(server, **wish))
    answer = server.request("POST", M + "/exports", {"max_triangles": 800, **wish})
    assert answer.status == 200, answer
    glb = Glb(answer.body)
    triangles = glb.triangles()
    assert 760 <= len(triangles) <= 800
    assert int(answer.headers["Strata-Triangles"]) == len(triangles)
    assert (read_png(glb.color_image()) == read_png(full.color_image())).all()
    check_valid(answer.body, tmp_path)
    assert area_of(glb.places(), triangles) == pytest.approx(model["area_m2"], rel=1e-3)
    places, uvs = in_model(glb)[triangles].mean(axis=1), glb.attribute("TEXCOORD_0")
    image = read_png(glb.color_image())
    colors = [pixel_at(image, uv)[:3].astype(int) for uv in uvs[triangles].mean(axis=1)]
    compare_colors(server, places, colors, 400)
    obj = Obj(export(server, format="obj", max_triangles=800, **wish))
    assert len(obj.corners) == len(triangles)


AROUND = {"at": {"point": [50, 50, 0]}, "radius_mm": 20}


def farthest_and_nearest(places, triangles):
    """Returns the distances of the corners of the triangles from the middle of AROUND."""
    distances = numpy.linalg.norm(places - AROUND["at"]["point"], axis=1)[triangles]
    return distances.max(axis=1), distances.min(axis=1)


def test_a_part_of_the_surface_has_whole_triangles_and_the_same_texture(server, tmp_path):
    wish = {"texture_format": "png", "texture_size": 512}
    full, content = Glb(export(server, **wish)), export(server, within=AROUND, **wish)
    check_valid(content, tmp_path)
    part = Glb(content)
    assert (read_png(part.color_image()) == read_png(full.color_image())).all()
    assert part.json["nodes"][0]["matrix"] == full.json["nodes"][0]["matrix"]
    # An edge of a triangle has 2.5 mm, and a texel of the part less than 0.1 mm.
    _, nearest = farthest_and_nearest(in_model(part), part.triangles())
    assert nearest.max() < 20
    farthest, nearest = farthest_and_nearest(in_model(full), full.triangles())
    inside, touched = (farthest < 19.9).sum(), (nearest < 20).sum()
    assert 100 < inside < len(part.triangles()) <= touched, (inside, touched)
    # The positions of the corners, without those that only other triangles use.
    given = {tuple(each) for each in full.attribute("POSITION").tolist()}
    used = {tuple(each) for each in part.attribute("POSITION").tolist()}
    assert used < given
    assert len(numpy.unique(part.triangles())) == len(part.attribute("POSITION"))
    obj = Obj(export(server, within=AROUND, format="obj", **wish))
    assert len(obj.corners) == len(part.triangles())


def test_a_part_can_be_a_condition_or_a_saved_selection(server):
    wish = {"texture_size": 512}
    selection = {"name": "Cracks", "audience": "everyone", "within": {"where": "units = 1"}}
    server.ok("POST", M + "/selections", selection)
    direct = export(server, within=selection["within"], **wish)
    assert export(server, within={"selection": "cracks"}, **wish) == direct
    some = len(Glb(direct).triangles())
    assert 300 < some < server.get(M).json()["triangles"] / 2
    reduced = Glb(export(server, within={"selection": "cracks"}, max_triangles=200, **wish))
    assert len(reduced.triangles()) <= 200
    features = Glb(export(server, within={"selection": "cracks"}, features="units", **wish))
    assert features.properties()["name"] == ["Crack", "Blister"]


def test_a_part_shows_an_earlier_state(server):
    sequence = int(server.get(M + "/layers/units/statistics").headers["Strata-Sequence"])
    within = {"where": "units = 1"}
    before = export(server, within=within, at=sequence, texture_size=512)
    dab(server, f"{M}/layers/units", 1, 90, 90, 8)
    assert export(server, within=within, at=sequence, texture_size=512) == before
    now = export(server, within=within, texture_size=512)
    assert len(Glb(now).triangles()) > len(Glb(before).triangles())


def test_a_job_reports_an_empty_part(server):
    wish = {"within": {"where": "units = 1 and units = 2"}, "texture_size": 512}
    answer = server.request("POST", M + "/exports", wish)
    assert (answer.status, answer.json()["field"]) == (422, "within"), answer
    prefer = {"Prefer": "respond-async"}
    job = server.request("POST", M + "/exports", wish, headers=prefer).json()["id"]
    done = server.wait_for_job(job)
    assert (done["state"], done["problem"]["field"]) == ("failed", "within"), done


def test_a_large_number_of_triangles_changes_nothing(server):
    wish = {"texture_size": 512, "layers": only(server)}
    answer = server.request("POST", M + "/exports", {"max_triangles": 10**6, **wish})
    assert answer.body == export(server, **wish)
    assert int(answer.headers["Strata-Triangles"]) == server.get(M).json()["triangles"]


def test_large_coordinates_keep_their_precision(server):
    """A 4 mm relief at UTM coordinates, which 32-bit floats would round to 0.5 m."""
    east, north = 562_000.125, 5_117_000.375
    rows = [
        (east + x / 100, north + y / 100, 2500 + 0.004 * math.sin(x / 3))
        for y in range(41)
        for x in range(41)
    ]
    faces = []
    for y in range(40):
        for x in range(40):
            a, b = y * 41 + x, (y + 1) * 41 + x
            faces += [(a, a + 1, b + 1), (a, b + 1, b)]
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\nproperty double x\n"
        f"property double y\nproperty double z\nelement face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    body = b"".join(struct.pack("<3d", *row) for row in rows)
    body += b"".join(struct.pack("<B3i", 3, *face) for face in faces)
    server.import_model(head + body, "relief.ply", name="Relief", unit="m")
    glb = Glb(export(server, "/models/relief", texture_size=512))
    places = glb.places()
    given = {(round(x * 1000), round(y * 1000)): z for x, y, z in rows}
    for x, y, z in zip(places[:, 0], -places[:, 2], places[:, 1]):
        key = (round(float(x) * 1000), round(float(y) * 1000))
        assert abs(given[key] - z) < 1e-6, (key, z)
    assert len({tuple(place) for place in places}) == len(rows)
    places = Obj(export(server, "/models/relief", texture_size=512, format="obj")).places
    assert len(places) == len(rows)
    for x, z, y in places:
        key = (round(float(x) * 1000), round(float(-y) * 1000))
        assert abs(given[key] - z) < 1e-7, (key, z)


def test_records_become_features_with_their_columns(server, tmp_path):
    # The newest values, also if nothing was painted since.
    third = server.get("/tables/finds/records/3").json()
    values = {"2nd-name": "=a", "state": "-"}
    server.ok("PATCH", "/tables/finds/records/3", {"version": third["version"], "values": values})
    content = export(server, features="finds", texture_size=512)
    check_valid(content, tmp_path, "EXT_mesh_features", "EXT_structural_metadata")
    glb = Glb(content)
    ids, features = glb.feature_ids()
    assert features["texture"]["channels"] == [0, 1] and features["nullFeatureId"] == 0xFFFF
    assert features["featureCount"] == 289 and features["propertyTable"] == 0
    values = glb.properties()
    assert all(IDENTIFIER.match(name) for name in values), list(values)
    assert values["key"] == list(range(1, 290)) and "never" not in values
    assert values["name"][:2] == ["Find 1", "Find 2"]
    assert values["column_name"] == values["name"]
    assert values["depth"][:3] == [0.25, -3, None] and values["loose"][:2] == ["true", None]
    assert values["firm"][:3] == [True, False, True] and values["state"][:3] == ["poor", None, "-"]
    assert values["_2nd_name"][:3] == ["Tür", None, "=a"]
    areas = server.get(M + "/layers/finds/quantities").json()["quantities"]
    assert values["area_m2"] == pytest.approx([each["area_m2"] for each in areas])
    check_ids(server, glb, ids, features, "finds", values["key"])
    schema = glb.json["extensions"]["EXT_structural_metadata"]["schema"]
    described = schema["classes"]["feature"]["properties"]
    assert (described["depth"]["name"], described["depth"]["description"]) == ("Depth", "Unit: m")
    assert described["_2nd_name"]["name"] == "2nd name" and described["key"]["name"] == "key"
    assert schema["enums"]["state"]["name"] == "State", schema["enums"]


def check_ids(server, glb, ids, features, layer, value_of):
    """The feature of each vertex has the value that the layer has there. At a seam, the layer has the
    value of one of the sides."""
    some = {True: 0, False: 0}
    for vertex, uvs in by_position(server, glb, f"layers={layer}"):
        there = {int(pixel_at(ids, uv)) for uv in uvs} - {features["nullFeatureId"]}
        is_valid = vertex[f"{layer}_valid"] == 1
        some[is_valid] += 1
        assert bool(there) == is_valid, (vertex, there)
        if is_valid:
            assert vertex[layer] in {value_of[feature] for feature in there}, (vertex, there)
    assert min(some.values()) > 100, some


def test_classes_become_features(server, tmp_path):
    content = export(server, features="units", texture_size=512, unlit=True)
    check_valid(
        content, tmp_path, "EXT_mesh_features", "EXT_structural_metadata", "KHR_materials_unlit"
    )
    glb = Glb(content)
    ids, features = glb.feature_ids()
    assert features["texture"]["channels"] == [0] and features["nullFeatureId"] == 255
    values = glb.properties()
    assert values["value"] == [1, 2] and values["name"] == ["Crack", "Blister"]
    check_ids(server, glb, ids, features, "units", values["value"])
    ranges = Glb(export(server, features="wet", texture_size=512)).properties()
    assert ranges["from"] == [0] and ranges["to"] == [10], ranges


def test_columns_that_a_person_does_not_see_are_left_out(server):
    eve = server.add_person("eve", "annotator")
    assert "price" in Glb(export(server, features="finds", texture_size=512)).properties()
    content = export(server, features="finds", texture_size=512, token=eve)
    assert "price" not in Glb(content).properties() and b"price" not in content.lower()


def test_a_job_makes_a_zip(server):
    prefer = {"Prefer": "respond-async"}
    wish = {"format": "obj", "texture_size": 512}
    job = server.request("POST", M + "/exports", wish, headers=prefer).json()["id"]
    done = server.wait_for_job(job)
    assert (done["state"], done["file"]["name"]) == ("done", "sheet.zip"), done
    file = server.ok("GET", f"/jobs/{job}/file")
    assert len(file.body) == done["file"]["bytes"]
    assert len(Obj(file.body).corners) == server.get(M).json()["triangles"]


def test_a_job_makes_the_file_and_can_be_cancelled(server):
    prefer = {"Prefer": "respond-async"}
    wish = {"features": "finds", "texture_size": 1024}
    answer = server.request("POST", M + "/exports", wish, headers=prefer)
    assert answer.status == 202, answer
    job = answer.json()["id"]
    done = server.wait_for_job(job)
    assert done["state"] == "done", done
    assert done["file"]["name"] == "sheet.glb"
    assert done["file"]["media_type"] == "model/gltf-binary"
    file = server.ok("GET", f"/jobs/{job}/file")
    assert len(file.body) == done["file"]["bytes"]
    glb = Glb(file.body)
    assert glb.primitive["extensions"]
    assert done["file"]["triangles"] == len(glb.triangles())
    job = server.request("POST", M + "/exports", {"texture_size": 8192}, headers=prefer)
    job = job.json()["id"]
    server.ok("DELETE", f"/jobs/{job}")
    assert server.wait_for_job(job)["state"] == "cancelled"


def test_separate_pieces_are_not_reduced_to_nothing(server):
    """60 cubes, whose corners are corners of charts."""
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)]
    faces += [(2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]
    cubes = ply(
        [(3 * i + x, y, z) for i in range(60) for x, y, z in corners],
        [tuple(8 * i + each for each in face) for i in range(60) for face in faces],
    )
    server.import_model(cubes, "cubes.ply", name="Cubes", unit="mm")
    wish = {"max_triangles": 100, "texture_size": 512}
    answer = server.request("POST", "/models/cubes/exports", wish)
    assert (answer.status, answer.json()["field"]) == (422, "max_triangles"), answer
    assert "720" in answer.json()["detail"], answer


def test_wrong_requests_are_refused(server):
    server.ok("POST", M + "/layers", {"name": "Empty", "type": "u8", "resolution": 2048})
    for wish, status, field in (
        ({"layers": [{"layer": "nothing"}]}, 404, "layers[0].layer"),
        ({"features": "nothing"}, 422, "features"),
        ({"features": "empty", "texture_size": 512}, 422, "features"),
        ({"texture_size": 100}, 422, "texture_size"),
        ({"texture_format": "webp"}, 422, "texture_format"),
        ({"format": "fbx"}, 422, "format"),
        ({"max_triangles": 99}, 422, "max_triangles"),
        ({"within": {"selection": "nothing"}}, 404, "within.selection"),
        ({"within": {"where": "nothing > 1"}}, 422, "within.where"),
        ({"within": {"where": "units >"}}, 422, "within.where"),
        ({"format": "obj", "features": "units"}, 422, "features"),
        ({"at": 99999}, 422, "at"),
    ):
        answer = server.request("POST", M + "/exports", wish)
        assert (answer.status, answer.json()["field"]) == (status, field), (wish, answer)


def test_the_surface_is_only_for_those_who_may_have_the_scan(server):
    viewer = server.add_person("vic", "viewer")
    answer = server.request("POST", M + "/exports", {}, token=viewer)
    assert answer.status == 403, answer
    server.ok("PATCH", M, {"source_download": "viewer"})
    content = export(server, texture_size=512, token=viewer)
    assert Glb(content).json["asset"]["version"] == "2.0"


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
