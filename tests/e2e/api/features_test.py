"""Outlines of classes, and lines and points of records, as GeoJSON and GeoPackage, read as other
programs read them."""
import contextlib
import os
import sqlite3
import struct
import tempfile

import pytest
from support.meshes import folded_grid
from support.readings import dab

M, T = "/models/sheet", "/tables/damage"  # a nearly flat sheet, x and y from 0 to 100 mm
TEXEL = 100 / 2048  # in mm, at the lowest resolution
GPKG = "application/geopackage+sqlite3"


def make(server):
    server.import_model(folded_grid(fold=0.0001), "sheet.ply", name="Sheet", unit="mm")
    model = server.get(M).json()["id"]
    classes = {
        "mode": "categorical",
        "points": [{"at": 1, "color": "#ff0000", "label": "Salt"}, {"at": 2, "color": "#0000ff"}],
    }
    server.ok(
        "POST",
        M + "/layers",
        {"name": "Units", "type": "u8", "resolution": 2048, "palette": classes},
    )
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Wet",
            "type": "f32",
            "resolution": 2048,
            "palette": {
                "mode": "step",
                "points": [{"at": 0, "color": "#000000"}, {"at": 5, "color": "#ffffff"}],
            },
        },
    )
    dab(server, f"{M}/layers/units", 1, 40, 40, 30)
    dab(server, f"{M}/layers/units", 2, 40, 40, 10)  # a hole in the first disc
    dab(server, f"{M}/layers/units", 2, 85, 85, 8)
    dab(server, f"{M}/layers/wet", 3, 20, 20, 5)
    dab(server, f"{M}/layers/wet", 7, 60, 60, 5)
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Damage",
            "columns": [
                {"name": "Code", "required": True},
                {"name": "Name"},
                {"name": "Depth", "kind": "numeric", "unit": "mm"},
                {"name": "Count", "kind": "integer"},
                {"name": "Wet", "kind": "boolean"},
                {"name": "Crack", "kind": "line"},
                {"name": "Sample", "kind": "point"},
                {"name": "Secret", "visibility": "private"},
            ],
        },
    )
    server.ok(
        "POST",
        M + "/layers",
        {
            "name": "Damage",
            "kind": "database",
            "type": "u16",
            "table": "damage",
            "resolution": 2048,
        },
    )
    place = lambda *places: [{"model": model, "coordinates": [list(each) for each in places]}]
    server.ok(
        "POST",
        T + "/records",
        {
            "values": {
                "code": "Loss",
                "name": "L",
                "depth": 1.5,
                "count": 3,
                "wet": True,
                "secret": "grave",
            }
        },
    )
    server.ok(
        "POST",
        T + "/records",
        {
            "values": {
                "code": "Crack “a”",
                "crack": place((20, 50, 0), (50, 50, 0), (50, 90, 0))
                + place((10, 10, 0), (10, 20, 0)),
            }
        },
    )
    server.ok("POST", T + "/records", {"values": {"code": "Sample", "sample": place((80, 20, 0))}})
    dab(server, f"{M}/layers/damage", 1, 30, 70, 10)


def ring_area(ring):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:])) / 2


def check_polygons(geometry, area_m2, metres=0.001):
    """Checks that rings are closed, that outer rings are counter-clockwise and holes clockwise, and
    that the area agrees with the statistics."""
    total = 0
    for polygon in geometry["coordinates"]:
        for i, ring in enumerate(polygon):
            assert (
                ring[0] == ring[-1] and len(ring) >= 4 and all(len(place) == 3 for place in ring)
            ), ring[:3]
            assert (ring_area(ring) > 0) == (i == 0), (i, ring_area(ring))
            total += ring_area(ring)
    assert abs(total * metres**2 / area_m2 - 1) < 0.01, (total, area_m2)


def features(server, layer, query=""):
    answer = server.ok("GET", f"{M}/layers/{layer}/features?{query}")
    assert answer.headers["Content-Type"] == "application/geo+json", answer.headers
    return answer.json()


@pytest.fixture(scope="module")
def server(server):
    make(server)
    return server


def test_classes(server):
    made = features(server, "units")
    assert (made["type"], made["name"], made["unit"], made["axes"]) == (
        "FeatureCollection",
        "sheet-units",
        "mm",
        "xyz",
    ) and "crs" not in made, made["name"]
    salt, other = made["features"]
    keys = {
        key["key"]: key
        for key in server.get(M + "/layers/units/statistics?include=perimeter,pieces").json()[
            "keys"
        ]
    }
    for feature, value, name in ((salt, 1, "Salt"), (other, 2, "2")):
        own = feature["properties"]
        assert (own["kind"], own["value"], own["name"], own["layer"], own["model"]) == (
            "areas",
            value,
            name,
            "units",
            "sheet",
        ), own
        for field in ("area_m2", "perimeter_m", "texels", "pieces"):
            assert abs(own[field] - keys[value][field]) <= 1e-9 * own[field], (
                field,
                own,
                keys[value],
            )
        assert feature["geometry"]["type"] == "MultiPolygon"
        check_polygons(feature["geometry"], own["area_m2"])
    assert [len(polygon) for polygon in salt["geometry"]["coordinates"]] == [2], "one hole"
    assert len(other["geometry"]["coordinates"]) == 2
    for ring in salt["geometry"]["coordinates"][0]:
        distances = {round(((x - 40) ** 2 + (y - 40) ** 2) ** 0.5) for x, y, _ in ring}
        assert distances <= {9, 10, 11, 29, 30, 31} and len(distances) <= 3, distances
        assert len(ring) < 0.6 * 8 * max(distances) / TEXEL, (
            len(ring),
            "fewer corners than the texels along it",
        )
    ranges = [feature["properties"] for feature in features(server, "wet")["features"]]
    assert [(own["from"], own["to"]) for own in ranges] == [(0, 5), (5, None)], ranges
    # from the side only the edge of the sheet is visible, and the coordinates are x, z, y
    side = features(server, "units", "along=-y")
    assert side["axes"] == "xzy" and [
        feature["properties"]["area_m2"] for feature in side["features"]
    ] == [feature["properties"]["area_m2"] for feature in made["features"]]
    past = features(server, "units", "at=1")
    assert [feature["properties"]["value"] for feature in past["features"]] == [1] and len(
        past["features"][0]["geometry"]["coordinates"][0]
    ) == 1


def test_records(server):
    made = features(server, "damage")["features"]
    kinds = [(feature["properties"]["kind"], feature["geometry"]["type"]) for feature in made]
    assert kinds == [
        ("areas", "MultiPolygon"),
        ("lines_crack", "LineString"),
        ("lines_crack", "LineString"),
        ("points_sample", "Point"),
    ], kinds
    area, line, short, point = made
    own = area["properties"]
    assert (
        own["key"],
        own["name"],
        own["code"],
        own["column_name"],
        own["depth"],
        own["count"],
        own["wet"],
    ) == (1, "Loss", "Loss", "L", 1.5, 3, True), own
    check_polygons(area["geometry"], own["area_m2"])
    assert (
        line["geometry"]["coordinates"] == [[20, 50, 0], [50, 50, 0], [50, 90, 0]]
        and line["properties"]["key"] == 2
    ), line
    assert (
        abs(line["properties"]["length_m"] - 0.07) < 1e-9
        and abs(short["properties"]["length_m"] - 0.01) < 1e-9
    )
    assert line["properties"]["name"] == "Crack “a”" and line["properties"]["depth"] is None
    assert point["geometry"]["coordinates"] == [80, 20, 0] and "length_m" not in point["properties"]
    assert features(server, "damage", "along=%2Bx")["features"][3]["geometry"]["coordinates"] == [
        20,
        0,
        80,
    ]


def test_a_package_without_a_reference_system(server):
    check_package(server, None)


def test_a_reference_system_counts_in_its_unit(server):
    server.ok("PATCH", M, {"crs": "EPSG:25832"})
    assert "crs" not in features(server, "units"), "its coordinates are metres"
    server.ok("PATCH", M, {"unit": "m"})
    assert features(server, "units")["crs"] == {
        "type": "name",
        "properties": {"name": "urn:ogc:def:crs:EPSG::25832"},
    }
    assert "crs" not in features(server, "units", "along=-x"), "x and y alone are in it"
    check_package(server, 25832, 1)


def read_blob(blob, srs):
    """Parses a GeoPackage geometry. Returns its type, and its numbers as in GeoJSON."""
    magic, version, flags, its_srs = struct.unpack_from("<2sBBi", blob)
    assert (magic, version, flags, its_srs) == (b"GP", 0, 0b101, srs), (
        magic,
        version,
        flags,
        its_srs,
    )
    box = struct.unpack_from("<6d", blob, 8)
    at = 56

    def take(code):
        nonlocal at
        values = struct.unpack_from("<" + code, blob, at)
        at += struct.calcsize("<" + code)
        return values

    def path():
        return [list(take("3d")) for _ in range(take("I")[0])]

    def geometry():
        order, kind = take("BI")
        assert order == 1
        if kind == 1001:
            return "Point", list(take("3d"))
        if kind == 1002:
            return "LineString", path()
        if kind == 1003:
            return "Polygon", [path() for _ in range(take("I")[0])]
        assert kind == 1006, kind
        return "MultiPolygon", [geometry()[1] for _ in range(take("I")[0])]

    kind, coordinates = geometry()
    assert at == len(blob)
    flat = coordinates
    while isinstance(flat[0], list) and isinstance(flat[0][0], list):
        flat = [each for part in flat for each in part]
    places = flat if isinstance(flat[0], list) else [flat]
    for axis in range(3):
        assert (box[2 * axis], box[2 * axis + 1]) == (
            min(place[axis] for place in places),
            max(place[axis] for place in places),
        ), box
    return {"type": kind, "coordinates": coordinates}


@contextlib.contextmanager
def opened(content):
    with tempfile.NamedTemporaryFile(suffix=".gpkg") as file:
        file.write(content)
        file.flush()
        with contextlib.closing(sqlite3.connect(file.name)) as database:
            yield database


def check_package(server, epsg, metres=0.001):
    answer = server.get(M + "/layers/damage/features", headers={"Accept": GPKG})
    assert (
        answer.status == 200
        and answer.headers["Content-Type"] == GPKG
        and answer.headers["Content-Disposition"].endswith("sheet-damage.gpkg")
    ), answer.headers
    assert answer.headers["Vary"] == "Accept"
    if folder := os.environ.get("STRATA_TEST_OUTPUT"):
        os.makedirs(folder, exist_ok=True)
        with open(os.path.join(folder, f"features-{epsg}.gpkg"), "wb") as file:
            file.write(answer.body)
    srs = epsg or -1
    with opened(answer.body) as database:
        ask = lambda sql: database.execute(sql).fetchall()
        assert (
            ask("PRAGMA application_id") == [(0x47504B47,)]
            and ask("PRAGMA user_version") == [(10300,)]
            and ask("PRAGMA integrity_check") == [("ok",)]
        )
        assert ask("PRAGMA foreign_key_check") == []
        known = {row[0] for row in ask("SELECT srs_id FROM gpkg_spatial_ref_sys")}
        assert known == {-1, 0, 4326} | ({epsg} if epsg else set()), known
        tables = ask("SELECT table_name, data_type, srs_id FROM gpkg_contents ORDER BY 1")
        assert tables == [
            (name, "features", srs) for name in ("areas", "lines_crack", "points_sample")
        ], tables
        columns = ask(
            "SELECT table_name, column_name, geometry_type_name, srs_id, z, m FROM gpkg_geometry_columns ORDER BY 1"
        )
        assert columns == [
            ("areas", "geom", "MULTIPOLYGON", srs, 1, 0),
            ("lines_crack", "geom", "LINESTRING", srs, 1, 0),
            ("points_sample", "geom", "POINT", srs, 1, 0),
        ], columns
        (row,) = ask(
            "SELECT geom, area_m2, key, code, column_name, depth, count, wet, name FROM areas"
        )
        assert row[2:] == (1, "Loss", "L", 1.5, 3, 1, "Loss"), row[1:]
        check_polygons(read_blob(row[0], srs), row[1], metres)
        lines = ask("SELECT geom, length_m, code FROM lines_crack ORDER BY fid")
        assert (
            read_blob(lines[0][0], srs)["coordinates"] == [[20, 50, 0], [50, 50, 0], [50, 90, 0]]
            and lines[0][2] == "Crack “a”"
        )
        assert read_blob(ask("SELECT geom FROM points_sample")[0][0], srs)["coordinates"] == [
            80,
            20,
            0,
        ]
        assert ask(
            "SELECT min_x, min_y, max_x, max_y FROM gpkg_contents WHERE table_name = 'points_sample'"
        ) == [(80, 20, 80, 20)]


def test_refusals(server):
    L = M + "/layers/units/features"
    for query, status, field in (
        ("f=shp", 406, "f"),
        ("along=z", 422, "along"),
        ("along=north", 422, "along"),
        ("at=99999", 422, "at"),
        ("lang=" + "x" * 36, 422, "lang"),
    ):
        answer = server.get(f"{L}?{query}")
        assert (answer.status, answer.json()["field"]) == (status, field), (query, answer)
    assert server.get(M + "/layers/nothing/features").status == 404
    assert server.get(L + "?format=gpkg").status == 400
    empty = server.ok(
        "POST", M + "/layers", {"name": "Empty", "type": "u8", "resolution": 2048}
    ).json()["slug"]
    assert features(server, empty)["features"] == []
    with opened(server.ok("GET", f"{M}/layers/{empty}/features?f=gpkg").body) as database:
        assert database.execute("SELECT count(*) FROM areas").fetchall() == [(0,)]


def test_who_sees_what(server):
    vera = server.add_person("vera", "viewer")
    mine = features(server, "damage")["features"][0]["properties"]
    hers = server.get(M + "/layers/damage/features", token=vera).json()["features"][0]["properties"]
    assert mine["secret"] == "grave" and "secret" not in hers and hers["code"] == "Loss", (
        mine,
        hers,
    )
    with opened(server.get(M + "/layers/damage/features?f=gpkg", token=vera).body) as database:
        assert "secret" not in [row[1] for row in database.execute("PRAGMA table_info(areas)")]
    server.ok("PATCH", M + "/layers/damage", {"visibility": "private"})
    assert server.get(M + "/layers/damage/features", token=vera).status == 404


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
