"""Flat maps that are painted into a layer: shapefiles, GeoTIFF, and scanned maps by their colors.
The file also tests refusals, undo and a restart."""
import json
import os
import urllib.parse

import pytest
from support.maps import dbf, form, packed, shp, square, tiff
from support.meshes import folded_grid
from support.pictures import pixels, png
from support.strata_server import wait_for

M = "/models/sheet"  # a sheet with x and y from 0 to 100, all visible from above
POLYGONS = [[square(10, 10, 20)], [square(50, 10, 20), square(55, 15, 5)], [square(10, 60, 30)]]
TABLE = [
    ("UNIT", "N", 6, ["11", "12", "13"]),
    ("STATE", "C", 12, ["salt", "crack", "salt"]),
    ("SOME", "N", 4, ["1", "", "3"]),
]
UTM = 'PROJCS["ETRS89 / UTM zone 30N",AUTHORITY["EPSG","25830"]]'


def layer(server, name, kind="u8", **more):
    made = server.ok(
        "POST", M + "/layers", {"name": name, "type": kind, "resolution": 2048, **more}
    ).json()
    return f"{M}/layers/{made['slug']}"


def values(server, path, *places):
    name = path.rsplit("/", 1)[1]
    answer = server.ok(
        "POST", M + "/positions", {"points": [[x, y, 0] for x, y in places], "layers": [name]}
    ).json()
    return [
        each["values"][name].get("value") if each["values"][name]["valid"] else None
        for each in answer["positions"]
    ]


def query(path, **parameters):
    return path + "?" + urllib.parse.urlencode(parameters)


def contents(server, body, headers=None, **parameters):
    return server.ok("POST", query(M + "/map-contents", **parameters), body, headers=headers).json()


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.01), "sheet.ply", name="Sheet", unit="mm")
    return server


def test_shapefile(server, story):
    files = {"units_shp": shp(POLYGONS), "units_dbf": dbf(TABLE)}
    body, headers = form(**files)
    told = contents(server, body, headers)
    assert (told["kind"], told["format"], told["polygons"], told["bounds"]) == (
        "polygons",
        "shapefile",
        3,
        [10, 10, 70, 90],
    ), told
    assert told["columns"] == [
        {"name": "UNIT", "type": "number", "samples": ["11", "12", "13"]},
        {"name": "STATE", "type": "text", "samples": ["salt", "crack"]},
        {"name": "SOME", "type": "mixed", "samples": ["1", "3"]},
    ], told["columns"]

    units = layer(server, "Units")
    places = [(20, 20), (60, 25), (57, 17), (25, 75), (90, 90)]
    painted = server.ok(
        "POST",
        query(units + "/polygons", attribute="UNIT"),
        body,
        headers={**headers, "Idempotency-Key": "units"},
    ).json()
    assert painted["texels_changed"] > 0 and values(server, units, *places) == [
        11,
        12,
        None,
        13,
        None,
    ], values(server, units, *places)
    # a repeat whose form has another boundary is the same request
    again = server.ok(
        "POST",
        query(units + "/polygons", attribute="UNIT"),
        body.replace(b"XyZ", b"other"),
        headers={"Content-Type": "multipart/form-data; boundary=other", "Idempotency-Key": "units"},
    ).json()
    assert again["sequence"] == painted["sequence"], again
    area = {key["key"]: key["area_m2"] for key in server.get(units + "/statistics").json()["keys"]}
    assert area[13] > 1.5 * area[11] > 1.5 * area[12] * 0.9, area
    history = server.get(units + "/edits").json()
    assert history["total"] == 1 and history["edits"][0]["op"] == "import", history
    server.ok("POST", units + "/undo")
    assert server.get(units + "/statistics").json()["texels"] == 0
    server.ok("POST", units + "/redo")
    assert values(server, units, *places) == [11, 12, None, 13, None]

    # one value for all polygons, from a zip with folders and without the attribute table
    zipped = packed(
        **{
            "survey/units_shp": files["units_shp"],
            "survey/read_me": b"",
            "__MACOSX/units_shp": b"x",
        }
    )
    server.ok(
        "POST",
        query(units + "/polygons", value=7),
        zipped,
        headers={"Content-Type": "application/zip"},
    )
    assert values(server, units, *places) == [7, 7, None, 7, None]

    # the journal stores file names in an unknown encoding like other names
    body, headers = form(**files)
    server.ok(
        "POST",
        query(units + "/polygons", value=8),
        body.replace(b"units.", b"Gr\xf6\xdfe."),
        headers=headers,
    )
    assert values(server, units, *places) == [8, 8, None, 8, None]

    states = layer(
        server,
        "States",
        palette={
            "mode": "categorical",
            "points": [{"at": 4, "color": "#112233", "label": "crack"}],
        },
    )
    server.ok("POST", query(states + "/polygons", attribute="STATE"), body, headers=headers)
    assert values(server, states, *places) == [1, 4, None, 1, None]
    points = server.get(states).json()["palette"]["points"]
    assert [(each["at"], each.get("label")) for each in points] == [
        (1, "salt"),
        (4, "crack"),
    ] and points[1]["color"] == "#112233ff", points
    # numbers with names, from GeoJSON
    feature = {
        "type": "Feature",
        "properties": {"id": 9, "what": "moss"},
        "geometry": {"type": "Polygon", "coordinates": [[[80, 80], [95, 80], [95, 95], [80, 95]]]},
    }
    server.ok("POST", query(states + "/polygons", attribute="id", names="what"), feature)
    assert values(server, states, *places) == [1, 4, None, 1, 9]
    assert {
        each["at"]: each.get("label") for each in server.get(states).json()["palette"]["points"]
    } == {1: "salt", 4: "crack", 9: "moss"}
    print("shapefile: ok", flush=True)
    story.states, story.places = states, places


def check_crs_question(server, path, good):
    """The model has no coordinate system. A map with a coordinate system is painted only if the
    request confirms that the coordinates of the model are also in that system."""
    polygons, of_polygons = form(a_shp=good, a_prj=UTM.encode())
    raster = tiff(10, 10, lambda x, y: x, kind="B", scale=10.0, origin=(0, 100), epsg=25830), {
        "Content-Type": "image/tiff"
    }
    assert (
        contents(server, polygons, of_polygons)["crs"]
        == contents(server, *raster)["crs"]
        == "EPSG:25830"
    )
    for where, body, headers in (
        (query(path + "/polygons", value=1), polygons, of_polygons),
        (query(path + "/picture", band=1), *raster),
        (query(path + "/picture", colors='{"#000000":1}'), *raster),
        (query(M + "/orthophotos", name="Ortho"), *raster),
    ):
        answer = server.post(where, body, headers=headers)
        assert (answer.status, answer.json()["title"], answer.json()["field"]) == (
            422,
            "Model without coordinate system",
            "crs",
        ), (where, answer)
        assert "crs=EPSG:25830" in answer.json()["detail"], answer
        for other in ("EPSG:32630", "25830", "EPSG:"):
            answer = server.post(where + "&crs=" + other, body, headers=headers)
            assert (answer.status, answer.json()["field"]) == (
                422,
                "crs",
            ) and "EPSG:25830" in answer.json()["detail"], (where, answer)
    assert server.get(path + "/edits").json()["total"] == 0
    for where, body, headers in (
        (query(path + "/polygons", value=1), polygons, of_polygons),
        (query(path + "/picture", band=1), *raster),
    ):
        assert (
            server.ok("POST", where + "&crs=EPSG:25830", body, headers=headers).json()[
                "texels_changed"
            ]
            > 0
        )
        server.ok("POST", path + "/undo")
    assert server.get(M).json()["crs"] == ""  # the confirmation applies only to this map


def test_shapefile_refusals(server):
    path = layer(server, "Refused")
    good, table = shp(POLYGONS), dbf(TABLE)
    for what, files, parameters, status, says in [
        (
            "a name without a legend",
            {"a_shp": good, "a_dbf": table},
            {"attribute": "STATE"},
            422,
            "categorical",
        ),
        (
            "an attribute that is not there",
            {"a_shp": good, "a_dbf": table},
            {"attribute": "DEPTH"},
            422,
            "UNIT, STATE, SOME",
        ),
        (
            "an attribute that some lack",
            {"a_shp": good, "a_dbf": table},
            {"attribute": "SOME"},
            422,
            "Record 2",
        ),
        (
            "an attribute without a table",
            {"a_shp": good, "a_prj": b""},
            {"attribute": "UNIT"},
            422,
            "It has no attributes",
        ),
        (
            "a table of another",
            {"a_shp": good, "a_dbf": dbf([("UNIT", "N", 6, ["1"])])},
            {"attribute": "UNIT"},
            422,
            "do not belong together",
        ),
        ("cut off", {"a_shp": good[:-20], "a_dbf": table}, {"value": 1}, 422, "is incomplete"),
        (
            "a table that is cut off",
            {"a_shp": good, "a_dbf": table[:-20]},
            {"value": 1},
            422,
            ".dbf is incomplete",
        ),
        ("two maps", {"a_shp": good, "b_shp": good}, {"value": 1}, 422, "a.shp, b.shp"),
        (
            "no map",
            {"a_dbf": table, "a_prj": b"x"},
            {"value": 1},
            415,
            "a.dbf is not a map on its own",
        ),
        ("a picture", {"a_png": png(1, 1, lambda x, y: (1, 2, 3))}, {"value": 1}, 415, "picture"),
        ("degrees", {"a_shp": good, "a_prj": b'GEOGCS["WGS 84"]'}, {"value": 1}, 422, "longitude"),
        ("a value that does not fit", {"a_shp": good}, {"value": 300}, 422, "300"),
        ("names of nothing", {"a_shp": good}, {"value": 3, "names": "STATE"}, 422, "names"),
    ]:
        body, headers = form(**files)
        answer = server.post(query(path + "/polygons", **parameters), body, headers=headers)
        assert answer.status == status and says in answer.json()["detail"], (what, answer)
    for what, body, status, says in [
        ("an empty zip", packed(notes_md=b"x"), 415, "contains no map"),
        ("a broken zip", packed(a_shp=good)[:-30], 422, "zip"),
    ]:
        answer = server.post(
            query(path + "/polygons", value=1), body, headers={"Content-Type": "application/zip"}
        )
        assert answer.status == status and says in answer.json()["detail"], (what, answer)
    assert server.get(path + "/edits").json()["total"] == 0
    check_crs_question(server, path, good)
    server.ok("PATCH", M, {"crs": "EPSG:32630"})
    body, headers = form(a_shp=good, a_prj=UTM.encode())
    answer = server.post(query(path + "/polygons", value=1), body, headers=headers)
    assert (
        answer.status == 422
        and "EPSG:25830" in answer.json()["detail"]
        and "EPSG:32630" in answer.json()["detail"]
    ), answer
    server.ok("PATCH", M, {"crs": "EPSG:25830"})
    server.ok("POST", query(path + "/polygons", value=1), body, headers=headers)
    print("refused shapefiles: ok", flush=True)


def test_raster(server):
    kind = {"Content-Type": "image/tiff"}
    # 10 × 10 pixels of 10 units over the sheet; the first row has the highest y
    height = lambda x, y: -9999 if (x, y) == (0, 0) else 0.5 * x + y
    raster = tiff(10, 10, height, nodata="-9999", scale=10.0, origin=(0, 100), epsg=25830)
    told = contents(server, raster, kind)
    assert (
        told["width"],
        told["height"],
        told["bands"],
        told["type"],
        told["nodata"],
        told["crs"],
    ) == (10, 10, 1, "f32", -9999, "EPSG:25830"), told
    assert (
        told["world"] == [10, 0, 0, -10, 5, 95]
        and told["bounds"] == [0, 0, 100, 100]
        and not told["has_colors"]
    ), told
    depth = layer(server, "Depth", "f32")
    server.ok("POST", depth + "/picture", raster, headers=kind)
    places = [(25, 95), (5, 95), (95, 5)]
    assert values(server, depth, *places) == [1.0, None, 13.5], values(server, depth, *places)
    server.ok("POST", depth + "/undo")
    assert values(server, depth, *places) == [None, None, None]
    # a position in the request overrides the file's own position, and so does a world file next to
    # it
    server.ok("POST", query(depth + "/picture", world="5,0,0,-5,2.5,97.5"), raster, headers=kind)
    assert values(server, depth, (12, 98)) == [1.0] and values(server, depth, (95, 5)) == [None]
    server.ok("POST", depth + "/undo")
    body, headers = form(a_tif=raster, a_tfw=b"10\n0\n0\n-10\n15\n95\n")
    server.ok("POST", depth + "/picture", body, headers=headers)
    assert values(server, depth, (15, 95), (25, 95)) == [None, 0.5]
    # a picture with two bands
    two = tiff(2, 1, lambda x, y: (x, 7 + x), kind="h", samples=2, scale=50.0, origin=(0, 100))
    counts = layer(server, "Counts", "i16")
    server.ok("POST", query(counts + "/picture", band=2), two, headers=kind)
    assert values(server, counts, (25, 75), (75, 75)) == [7, 8]

    grey = layer(server, "Grey")
    for what, file, parameters, status, says in [
        ("without a place", tiff(1, 1, lambda x, y: 1.0), {}, 422, "world"),
        ("a fraction in a whole layer", raster, {}, 422, "Pixel 1, 0"),
        ("no such band", two, {"band": 3}, 422, "1 to 2"),
        ("band zero", two, {"band": 0}, 422, "band"),
        ("a band and colours", two, {"band": 1, "colors": "auto"}, 422, "not both"),
        ("colours of numbers", raster, {"colors": "auto"}, 422, "instead of colors"),
        (
            "another system",
            tiff(1, 1, lambda x, y: 1, kind="B", scale=1.0, origin=(0, 0), epsg=32633),
            {},
            422,
            "EPSG:32633",
        ),
        ("cut off", raster[:-40], {}, 422, "cannot be read"),
        ("nothing but a head", raster[:8], {}, 422, "cannot be read"),
        (
            "pixels without a size",
            tiff(1, 1, lambda x, y: 1, kind="B", scale=1e-320, origin=(0, 0)),
            {},
            422,
            "area",
        ),
    ]:
        answer = server.post(query(grey + "/picture", **parameters), file, headers=kind)
        assert answer.status == status and (
            says in answer.json()["detail"] or says == answer.json().get("field")
        ), (what, answer)
    body, headers = form(a_tif=two, a_tfw=b"1 2 3")
    assert server.post(grey + "/picture", body, headers=headers).status == 422
    assert server.post(M + "/map-contents", body, headers=headers).status == 422
    assert (
        server.post(
            M + "/map-contents?tolerance=0", b"{}", headers={"Content-Type": "application/geo+json"}
        ).json()["field"]
        == "tolerance"
    )
    assert server.get(grey + "/edits").json()["total"] == 0
    print("rasters: ok", flush=True)


def test_colors(server):
    def scanned(x, y):
        shake = (x * 7 + y * 13) % 9 - 4
        color = (238, 232, 218)
        if 10 <= x < 40 and 10 <= y < 40:
            color = (188, 44, 40)
        if 60 <= x < 90 and 10 <= y < 30:
            color = (44, 64, 180)
        return tuple(each + shake for each in color)

    picture = png(100, 100, scanned)  # one pixel per unit; the first row is at y = 100
    place = "1,0,0,-1,0.5,99.5"
    told = contents(server, picture, {"Content-Type": "image/png"})
    colors = told["colors"]
    assert told["kind"] == "picture" and "world" not in told and len(colors) == 3, told
    assert [each["background"] for each in colors] == [True, False, False] and abs(
        colors[1]["share"] - 0.09
    ) < 0.005, colors
    pigments = layer(server, "Pigments", palette={"mode": "categorical", "points": []})
    keys = json.dumps({colors[1]["color"]: 5, "#2c40b4": 6})
    server.ok("POST", query(pigments + "/picture", world=place, colors=keys), picture)
    places = [(25, 75), (75, 80), (50, 50), (75, 60)]
    assert values(server, pigments, *places) == [5, 6, None, None], values(
        server, pigments, *places
    )
    points = {
        each["at"]: each["color"] for each in server.get(pigments).json()["palette"]["points"]
    }
    assert points == {5: colors[1]["color"] + "ff", 6: "#2c40b4ff"}, points
    server.ok("POST", pigments + "/undo")
    server.ok("POST", query(pigments + "/picture", world=place, colors="auto"), picture)
    assert values(server, pigments, *places) == [1, 2, None, None]
    for what, parameters, says in [
        ("no object", {"colors": "red"}, "object"),
        ("no colour", {"colors": '{"red":1}'}, "#rrggbb"),
        ("no number", {"colors": '{"#ff0000":"a"}'}, "number"),
        ("too large a value", {"colors": '{"#ff0000":300}'}, "300"),
        ("no tolerance", {"colors": "auto", "tolerance": 0}, "tolerance"),
    ]:
        answer = server.post(query(pigments + "/picture", world=place, **parameters), picture)
        assert answer.status == 422 and says in answer.json()["detail"], (what, answer)
    blank = server.post(
        query(pigments + "/picture", world=place, colors="auto"), png(4, 4, lambda x, y: (9, 9, 9))
    )
    assert blank.status == 422 and "background" in blank.json()["detail"], blank
    print("colours: ok", flush=True)


def look_colors(server, look, *places):
    """Returns the colors that a camera from above sees at these points of the sheet, unlit."""
    answer = server.ok(
        "POST",
        M + "/frame",
        {
            "camera": ABOVE,
            "format": "png",
            "layers": [],
            "looks": [{"look": look}],
            "light": {"mode": "unlit"},
        },
    )
    rows = pixels(answer.body)
    return [rows[round(400 - 4 * y - 0.5)][round(4 * x - 0.5)] for x, y in places]


# 400 × 400 pixels over the sheet, without perspective
ABOVE = {
    "view": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -50, -50, -100, 1],
    "projection": [0.02, 0, 0, 0, 0, 0.02, 0, 0, 0, 0, -0.01, 0, 0, 0, -1, 1],
    "width": 400,
    "height": 400,
}


def test_orthophoto(server, story):
    def colored(x, y):
        return (220, 30, 30) if x < 25 else (30, 30, 220) if y < 15 else (30, 200, 30)

    picture = png(40, 40, colored)  # covers x from 0 to 80 and y from 20 to 100
    plain = look_colors(
        server,
        server.ok("POST", M + "/looks?name=White", png(8, 8, lambda x, y: (255, 255, 255))).json()[
            "id"
        ],
        (90, 10),
    )
    body, headers = form(site_png=picture, site_pgw=b"2\n0\n0\n-2\n1\n99\n")
    headers["Idempotency-Key"] = "ortho"
    started = server.ok(
        "POST",
        query(M + "/orthophotos", name="Orthophoto 2024"),
        body,
        expect=(202,),
        headers=headers,
    ).json()
    job = server.wait_for_job(started["id"])
    assert job["state"] == "done" and job["model"] == server.get(M).json()["id"], job
    look = server.get(f"{M}/looks/{job['look']}").json()
    assert (look["name"], look["slug"], look["visible"], look["media_type"]) == (
        "Orthophoto 2024",
        "orthophoto-2024",
        False,
        "image/png",
    ), look
    assert (
        server.ok(
            "POST",
            query(M + "/orthophotos", name="Orthophoto 2024"),
            body,
            expect=(202,),
            headers=headers,
        ).json()["id"]
        == job["id"]
    )
    # points in the middle of charts
    seen = look_colors(server, look["id"], (30, 90), (70, 90), (70, 50), (48, 90), (52, 90))
    near = lambda a, b: all(abs(x - y) <= 3 for x, y in zip(a, b))
    wanted = [(220, 30, 30), (30, 30, 220), (30, 200, 30), (220, 30, 30), (30, 30, 220)]
    assert all(near(a, b) for a, b in zip(seen, wanted)), seen
    # The picture ends at x = 80 and y = 20. Outside there is no color of the picture, and inside
    # there is no dark seam.
    bare = look_colors(server, look["id"], (90, 10), (77, 50))
    assert (
        not near(bare[0], plain[0])
        and max(bare[0]) - min(bare[0]) < 30
        and near(bare[1], (30, 200, 30))
    ), bare

    tall = tiff(
        4,
        4,
        lambda x, y: (10, 200, 200, 255 if x < 2 else 0),
        kind="B",
        samples=4,
        scale=25.0,
        origin=(0, 100),
        epsg=25830,
    )
    started = server.ok(
        "POST",
        query(M + "/orthophotos", name="Half", resolution=2048),
        tall,
        expect=(202,),
        headers={"Content-Type": "image/tiff"},
    ).json()
    half = server.wait_for_job(started["id"])
    assert half["state"] == "done", half
    seen = look_colors(server, half["look"], (30, 50), (70, 50))
    assert near(seen[0], (10, 200, 200)) and not near(seen[1], (10, 200, 200)), seen
    assert server.get(f"{M}/looks/{half['look']}").json()["width"] == 2048

    count = server.get(M + "/looks").json()["total"]
    for what, body, parameters, status, field in [
        ("no name", picture, {"world": "2,0,0,-2,1,99"}, 422, "name"),
        ("no place", picture, {"name": "x"}, 422, "world"),
        (
            "polygons",
            b'{"type":"Polygon","coordinates":[[[0,0],[1,0],[1,1]]]}',
            {"name": "x", "world": "2,0,0,-2,1,99"},
            415,
            "body",
        ),
        (
            "no power of two",
            picture,
            {"name": "x", "world": "2,0,0,-2,1,99", "resolution": 3000},
            422,
            "resolution",
        ),
        (
            "too coarse",
            picture,
            {"name": "x", "world": "2,0,0,-2,1,99", "resolution": 512},
            422,
            "resolution",
        ),
        (
            "too fine",
            picture,
            {"name": "x", "world": "2,0,0,-2,1,99", "resolution": 16384},
            422,
            "resolution",
        ),
        (
            "numbers",
            tiff(1, 1, lambda x, y: 0.5, scale=1.0, origin=(0, 1)),
            {"name": "x"},
            422,
            "body",
        ),
        ("damaged", picture[:-20], {"name": "x", "world": "2,0,0,-2,1,99"}, 422, None),
    ]:
        answer = server.post(query(M + "/orthophotos", **parameters), body)
        assert answer.status == status and answer.json().get("field") == field, (what, answer)
    far = server.wait_for_job(
        server.ok(
            "POST",
            query(M + "/orthophotos", name="x", world="1,0,0,-1,5000,5000"),
            picture,
            expect=(202,),
        ).json()["id"]
    )
    assert far["state"] == "failed" and far["problem"]["field"] == "world", far
    assert server.get(M + "/looks").json()["total"] == count
    print("orthophotos: ok", flush=True)
    story.look, story.color = job["look"], wanted[0]


def test_cancelled_orthophoto(server):
    """A job that is canceled while it runs leaves neither a surface image nor a file, and the name
    can be used again."""
    things = lambda: (
        [look["slug"] for look in server.get(M + "/looks").json()["looks"]],
        os.listdir(os.path.join(server.data, "uploads")),
    )
    before = things()
    picture, asked = png(64, 64, lambda x, y: (x, y, 99)), {
        "name": "Never",
        "world": "2,0,0,-2,1,99",
    }
    job = server.ok(
        "POST", query(M + "/orthophotos", resolution=8192, **asked), picture, expect=(202,)
    ).json()["id"]
    wait_for(lambda: server.get(f"/jobs/{job}").json()["state"] == "running", "the job to run")
    server.ok("DELETE", f"/jobs/{job}")
    over = server.wait_for_job(job)
    assert over["state"] == "cancelled" and "look" not in over, over
    wait_for(lambda: things() == before, f"nothing to be left: {before} {things()}")
    assert server.request("DELETE", f"/jobs/{job}").status == 409, "it is over"
    again = server.wait_for_job(
        server.ok(
            "POST", query(M + "/orthophotos", resolution=2048, **asked), picture, expect=(202,)
        ).json()["id"]
    )
    assert server.get(f"{M}/looks/{again['look']}").json()["slug"] == "never", again
    print("cancelled orthophoto: ok", flush=True)


def test_what_was_painted_survives_the_end_of_the_server(server, story):
    server.kill()
    server.start()
    assert values(server, story.states, *story.places) == [1, 4, None, 1, 9]
    assert look_colors(server, story.look, (30, 90)) == [story.color]


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
