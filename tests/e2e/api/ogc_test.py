"""The OGC APIs, read as GIS programs read them: with GDAL's programs, and with the rules of the
standards."""
import base64
import json
import math
import os
import subprocess
import tempfile

import pytest
from support import qgis_layers
from support.addresses import query
from support.meshes import folded_grid, ply
from support.project_sites import Someone
from support.readings import dab

CRS84 = "http://www.opengis.net/def/crs/OGC/1.3/CRS84"
UTM = "http://www.opengis.net/def/crs/EPSG/0/25832"
EAST, NORTH = 412_000.0, 5_650_000.0  # corner of the field, in EPSG:25832
RADIUS = 6_378_137.0


def field_at(east, north):
    """A flat field of 100 m × 100 m."""
    side = 20
    vertices = [
        (east + 5.0 * j, north + 5.0 * i, 100.0) for i in range(side + 1) for j in range(side + 1)
    ]
    faces = []
    for i in range(side):
        for j in range(side):
            a = i * (side + 1) + j
            faces += [(a, a + 1, a + side + 2), (a, a + side + 2, a + side + 1)]
    return ply(vertices, faces)


def make(server):
    server.import_model(folded_grid(fold=0.0001), "sheet.ply", name="Sheet", unit="mm")
    sheet = server.get("/models/sheet").json()["id"]
    classes = {
        "mode": "categorical",
        "points": [{"at": 1, "color": "#ff0000", "label": "Salt"}, {"at": 2, "color": "#0000ff"}],
    }
    layer = {"type": "u8", "resolution": 2048, "palette": classes}
    server.ok("POST", "/models/sheet/layers", {"name": "Units", **layer})
    server.ok(
        "POST",
        "/models/sheet/layers",
        {"name": "Wet", "type": "f32", "unit": "%", "resolution": 2048, "description": "Moisture"},
    )
    dab(server, "/models/sheet/layers/units", 1, 40, 40, 30)
    dab(server, "/models/sheet/layers/units", 2, 85, 85, 8)
    dab(server, "/models/sheet/layers/wet", 12.5, 20, 30, 10)
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Damage",
            "columns": [
                {"name": "Code", "required": True},
                {"name": "Crack", "kind": "line"},
                {"name": "Sample", "kind": "point"},
                {"name": "Secret", "visibility": "private"},
            ],
        },
    )
    damage = {"name": "Damage", "kind": "database", "type": "u16", "table": "damage"}
    server.ok("POST", "/models/sheet/layers", {**damage, "resolution": 2048})
    place = lambda *places: [{"model": sheet, "coordinates": [list(each) for each in places]}]
    for values in (
        {"code": "Loss", "secret": "grave"},
        {"code": "Crack “a”", "crack": place((20, 50, 0), (50, 50, 0), (50, 90, 0))},
        {"code": "Sample", "sample": place((80, 20, 0))},
    ):
        server.ok("POST", "/tables/damage/records", {"values": values})
    dab(server, "/models/sheet/layers/damage", 1, 30, 70, 10)

    server.import_model(field_at(EAST, NORTH), "field.ply", name="Field", unit="m")
    server.ok("PATCH", "/models/field", {"crs": "EPSG:25832"})
    server.ok("POST", "/models/field/layers", {"name": "Pits", **layer})
    server.ok(
        "POST",
        "/models/field/layers/pits/readings?radius_mm=10000",
        f"x,y,z,value\n{EAST + 30},{NORTH + 60},100,1\n",
        headers={"Content-Type": "text/csv"},
    )


@pytest.fixture(scope="module")
def server(server):
    make(server)
    return server


def ogc(server, path, **parameters):
    answer = server.ok("GET", query("//ogc" + path, **parameters) if parameters else "//ogc" + path)
    return answer.json()


def run(server, *command):
    """Runs a program of GDAL with the owner's token. Returns its JSON."""
    environment = {
        **os.environ,
        "GDAL_HTTP_USERPWD": f"owner:{server.token}",
        "CPL_CURL_VERBOSE": "NO",
    }
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, (command, done.stdout, done.stderr)
    return done.stdout


def link(document, relation):
    return next(each for each in document["links"] if each["rel"] == relation)


def ring_area(ring):
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(ring, ring[1:])) / 2


def area_of(geometry):
    return sum(ring_area(ring) for polygon in geometry["coordinates"] for ring in polygon)


def test_a_client_finds_everything_from_the_landing_page(server):
    landing = ogc(server, "")
    host = server.url
    assert link(landing, "data")["href"] == f"{host}/ogc/collections"
    classes = ogc(server, "/conformance")["conformsTo"]
    assert "http://www.opengis.net/spec/ogcapi-features-1/1.0/conf/core" in classes
    collections = {each["id"]: each for each in ogc(server, "/collections")["collections"]}
    assert sorted(collections) == [
        "field",
        "field.pits",
        "sheet",
        "sheet.damage",
        "sheet.damage.crack",
        "sheet.damage.sample",
        "sheet.units",
        "sheet.wet",
    ]
    for name, collection in collections.items():
        assert {**ogc(server, f"/collections/{name}"), "links": 0} == {**collection, "links": 0}
        for each in collection["links"]:
            if each["rel"] != "data":  # these links need parameters
                assert each["href"].startswith(host + "/")
                server.ok("GET", "/" + each["href"].removeprefix(host), headers={"Accept": "*/*"})
    assert collections["field.pits"]["crs"] == [CRS84, UTM]
    west, south, east, north = collections["field.pits"]["extent"]["spatial"]["bbox"][0]
    metres = math.pi / 180 * RADIUS
    assert abs((north - south) * metres - 100) < 2, "degrees of latitude"
    assert abs((east - west) * metres * math.cos(math.radians(south)) - 100) < 3
    assert collections["sheet.units"]["crs"] == [f"{host}/ogc/crs/sheet/xy"]
    box = collections["sheet.units"]["extent"]["spatial"]["bbox"][0]
    assert all(abs(a - b) < 1e-5 for a, b in zip(box, (0, 0, 0.1, 0.1))), box
    assert collections["sheet.damage.crack"]["itemType"] == "feature"


def test_the_documents_are_pages_for_browsers(server):
    for path in ("", "/conformance", "/collections", "/collections/sheet.units"):
        answer = server.ok("GET", "//ogc" + path, headers={"Accept": "text/html,*/*;q=0.8"})
        assert answer.headers["Content-Type"].startswith("text/html"), answer.headers
        text = answer.body.decode()
        assert "<script" not in text and "<h1>" in text
        assert server.ok("GET", f"//ogc{path}?f=html").body == answer.body
        assert server.get(f"//ogc{path}?f=json").json()["links"], path
    listed = server.ok("GET", "//ogc/collections?f=html").body.decode()
    assert "sheet.damage.crack" in listed and "?f=html" in listed


def test_features_of_a_local_plane_are_in_meters(server):
    made = ogc(server, "/collections/sheet.units/items")
    assert (made["type"], made["numberMatched"], made["numberReturned"]) == (
        "FeatureCollection",
        2,
        2,
    )
    salt, other = made["features"]
    assert (salt["id"], salt["properties"]["name"], other["id"]) == ("1", "Salt", "2")
    for feature in (salt, other):
        area = area_of(feature["geometry"])
        assert abs(area / feature["properties"]["area_m2"] - 1) < 0.01, (area, feature)
    assert all(len(place) == 2 for place in salt["geometry"]["coordinates"][0][0])
    one = ogc(server, "/collections/sheet.units/items/2")
    assert {**one, "links": 0} == {**other, "links": 0}
    first = ogc(server, "/collections/sheet.units/items", limit=1)
    assert [each["id"] for each in first["features"]] == ["1"] and first["numberMatched"] == 2
    following = link(first, "next")["href"].removeprefix(server.url)
    second = server.ok("GET", "/" + following).json()
    assert [each["id"] for each in second["features"]] == ["2"] and link(second, "prev")
    assert "next" not in {each["rel"] for each in second["links"]}


def test_boxes_select_what_they_touch(server):
    ids = lambda name, box: [
        each["id"] for each in ogc(server, f"/collections/{name}/items", bbox=box)["features"]
    ]
    assert ids("sheet.units", "0.06,0.06,0.1,0.1") == ["1", "2"], "the disc reaches 0.061"
    assert ids("sheet.units", "0.065,0.065,0.1,0.1") == ["2"]
    assert ids("sheet.units", "0.03,0.03,0.031,0.031") == ["1"], "a box inside the disc"
    assert ids("sheet.units", "0.09,0.01,0.1,0.02") == []
    assert ids("sheet.damage.crack", "0.03,0.04,0.04,0.06") == ["2-1"], "only a side crosses it"
    assert ids("sheet.damage.crack", "0.03,0.06,0.04,0.08") == []
    assert ids("sheet.damage.sample", "0.079,0.019,0,0.081,0.021,9") == ["3-1"]


def test_features_of_a_map_are_in_its_system_and_in_degrees(server):
    plane = ogc(server, "/collections/field.pits/items", crs=UTM)["features"][0]
    area = area_of(plane["geometry"])
    assert abs(area / (math.pi * 100) - 1) < 0.01, area
    corners = [place for ring in plane["geometry"]["coordinates"][0] for place in ring]
    for x, y in corners:
        assert abs(math.dist((x, y), (EAST + 30, NORTH + 60)) - 10) < 0.2, (x, y)
    answer = server.ok("GET", "//ogc/collections/field.pits/items")
    assert answer.headers["Content-Crs"] == f"<{CRS84}>"
    # GDAL converts the same corners independently.
    asked = "\n".join(f"{x} {y}" for x, y in corners)
    done = subprocess.run(
        ["gdaltransform", "-s_srs", "EPSG:25832", "-t_srs", "OGC:CRS84", "-output_xy"],
        input=asked,
        capture_output=True,
        text=True,
        check=True,
    ).stdout.split("\n")
    degrees = answer.json()["features"][0]["geometry"]["coordinates"][0]
    for got, line in zip([place for ring in degrees for place in ring], done):
        wanted = [float(number) for number in line.split()]
        assert math.dist(got, wanted) < 2e-9, (got, wanted)
    longitude, latitude = degrees[0][0]
    box = f"{longitude - 1e-6},{latitude - 1e-6},{longitude + 1e-6},{latitude + 1e-6}"
    assert ogc(server, "/collections/field.pits/items", bbox=box)["numberMatched"] == 1
    east = {"bbox": f"{EAST + 60},{NORTH},{EAST + 99},{NORTH + 99}", "bbox-crs": "EPSG:25832"}
    assert ogc(server, "/collections/field.pits/items", **east)["numberMatched"] == 0


def test_gdal_reads_the_features(server):
    source = f"OAPIF:{server.url}/ogc"
    listed = run(server, "ogrinfo", "-ro", "-q", source)
    for name in ("field.pits", "sheet.units", "sheet.damage.crack", "sheet.damage.sample"):
        assert name in listed, listed
    with tempfile.TemporaryDirectory() as folder:
        for name, kind, count in (
            ("field.pits", "MultiPolygon", 1),
            ("sheet.units", "MultiPolygon", 2),
            ("sheet.damage.crack", "LineString", 1),
            ("sheet.damage.sample", "Point", 1),
        ):
            file = os.path.join(folder, name + ".geojson")
            run(server, "ogr2ogr", "-f", "GeoJSON", file, source, name)
            with open(file, encoding="utf-8") as opened:
                read = json.load(opened)["features"]
            assert len(read) == count and read[0]["geometry"]["type"] == kind, read
    assert "Crack “a”" in run(server, "ogrinfo", "-ro", "-al", source, "sheet.damage.crack")


def gdal_values(file, places):
    """Returns the values of a raster at georeferenced places, as GDAL reads them."""
    done = subprocess.run(
        ["gdallocationinfo", "-valonly", "-geoloc", file],
        input="\n".join(f"{x} {y}" for x, y in places),
        capture_output=True,
        text=True,
        check=True,
    )
    return [line.strip() for line in done.stdout.split("\n")[: len(places)]]


def test_gdal_reads_the_coverages(server):
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "pits.tif")
        answer = server.ok("GET", "//ogc/collections/field.pits/coverage")
        assert answer.headers["Content-Type"] == "image/tiff; application=geotiff"
        with open(file, "wb") as opened:
            opened.write(answer.body)
        info = json.loads(run(server, "gdalinfo", "-json", "-stats", file))
        assert 'ID["EPSG",25832]' in info["coordinateSystem"]["wkt"]
        band = info["bands"][0]
        assert (band["type"], band["noDataValue"], band["description"]) == ("Byte", 0, "Pits")
        (left, bottom), (right, top) = (
            info["cornerCoordinates"][c] for c in ("lowerLeft", "upperRight")
        )
        for got, wanted in ((left, EAST), (bottom, NORTH), (right, EAST + 100), (top, NORTH + 100)):
            assert abs(got - wanted) < 0.01, info["cornerCoordinates"]
        # The cells have about the size of a texel, so they also have the area of the disc.
        cell = abs(info["geoTransform"][1] * info["geoTransform"][5])
        share = float(band["metadata"][""]["STATISTICS_VALID_PERCENT"]) / 100
        assert abs(share * 10_000 / (math.pi * 100) - 1) < 0.02, share
        assert 0.5 * 10_000 / 2048**2 < cell < 4 * 10_000 / 2048**2, cell
        values = gdal_values(
            file,
            [
                (EAST + 30, NORTH + 60),
                (EAST + 30, NORTH + 69),
                (EAST + 30, NORTH + 71),
                (EAST + 60, NORTH + 30),
            ],
        )
        assert values == ["1", "1", "0", "0"], values

        file = os.path.join(folder, "wet.tif")
        asked = query(
            "//ogc/collections/sheet.wet/coverage", subset="x(0:0.05),y(0.01:*)", width=100
        )
        with open(file, "wb") as opened:
            opened.write(server.ok("GET", asked).body)
        info = json.loads(run(server, "gdalinfo", "-json", file))
        assert info["size"] == [100, 180], info["size"]
        band = info["bands"][0]
        assert (band["type"], band["noDataValue"], band["unit"]) == ("Float32", "NaN", "%"), band
        assert (
            "LOCAL_CS" in info["coordinateSystem"]["wkt"]
            or "ENGCRS" in info["coordinateSystem"]["wkt"]
        )
        values = gdal_values(file, [(0.02, 0.03), (0.04, 0.09)])
        assert values == ["12.5", "nan"], values


def has_qgis():
    return (
        subprocess.run(
            ["/usr/bin/python3", "-c", "import qgis.core"], capture_output=True, check=False
        ).returncode
        == 0
    )


def test_qgis_reads_features_and_coverages(server):
    if not has_qgis():
        pytest.skip("needs python3-qgis and qgis-providers")
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "pits.tif")
        with open(file, "wb") as opened:
            opened.write(server.ok("GET", "//ogc/collections/field.pits/coverage?width=500").body)
        names = ["field.pits", "sheet.units", "sheet.damage.crack", "sheet.damage.sample", file]
        script = os.path.join(os.path.dirname(qgis_layers.__file__), "qgis_layers.py")
        read = run(server, "/usr/bin/python3", script, server.url, server.token, *names)
        seen = json.loads(read.strip().split("\n")[-1])
    assert all(seen.values()), seen
    pits = seen["field.pits"]
    assert pits["count"] == 1 and "area_m2" in pits["fields"], pits
    assert pits["crs"] in ("EPSG:4326", "OGC:CRS84"), "by the version of QGIS"
    assert seen["sheet.units"]["count"] == 2 and seen["sheet.damage.crack"]["count"] == 1
    assert "Polygon" in seen["sheet.units"]["kind"] and "Line" in seen["sheet.damage.crack"]["kind"]
    assert seen["pits.tif"] == {"crs": "EPSG:25832", "size": [500, 500], "nodata": 0}, seen


def test_a_coverage_comes_back_as_the_same_map(server):
    """The GeoTIFF of a layer is painted on a new layer, whose values are then the same."""
    tiff = server.ok("GET", "//ogc/collections/field.pits/coverage").body
    server.ok("POST", "/models/field/layers", {"name": "Copy", "type": "u8", "resolution": 2048})
    server.ok(
        "POST",
        "/models/field/layers/copy/picture?band=1",
        tiff,
        headers={"Content-Type": "image/tiff"},
    )
    areas = [
        server.get(f"/models/field/layers/{layer}/statistics").json()["area_m2"]
        for layer in ("pits", "copy")
    ]
    server.ok("DELETE", "/models/field/layers/copy")
    assert abs(areas[1] / areas[0] - 1) < 0.005, areas


def test_values_at_positions(server):
    def values(coords, **more):
        made = ogc(server, "/collections/sheet/position", coords=coords, **more)
        assert made["domain"]["domainType"] == "Point"
        return {name: each["values"][0] for name, each in made["ranges"].items()}

    assert values("POINT(0.02 0.03)") == {"units": 1, "wet": 12.5, "damage": None}
    assert values("POINT(0.02 0.03)", **{"parameter-name": "wet"}) == {"wet": 12.5}
    assert values("POINT Z(0.02 0.03 0.5)", **{"parameter-name": "wet"}) == {"wet": 12.5}
    assert values("POINT(5 5)", **{"parameter-name": "wet,units"}) == {"wet": None, "units": None}
    several = ogc(
        server, "/collections/sheet/position", coords="MULTIPOINT((0.02 0.03),(0.09 0.01))"
    )
    assert [each["ranges"]["wet"]["values"] for each in several["coverages"]] == [[12.5], [None]]
    made = ogc(server, "/collections/sheet/position", coords="POINT(0.02 0.03)")
    assert made["parameters"]["wet"]["unit"]["symbol"] == "%"
    # The first position of the field's layer in degrees is where GDAL sees it.
    degrees = ogc(server, "/collections/field.pits/items")["features"][0]["geometry"][
        "coordinates"
    ][0][0]
    middle = [sum(place[axis] for place in degrees[1:]) / (len(degrees) - 1) for axis in (0, 1)]
    found = ogc(server, "/collections/field/position", coords=f"POINT({middle[0]} {middle[1]})")
    assert found["ranges"]["pits"]["values"] == [1]
    assert found["domain"]["referencing"][0]["system"]["id"] == CRS84


def test_values_along_a_line_and_in_an_area(server):
    line = ogc(
        server,
        "/collections/sheet/trajectory",
        coords="LINESTRING(0.005 0.03, 0.035 0.03)",
        **{"parameter-name": "wet"},
    )
    composite = line["domain"]["axes"]["composite"]
    assert composite["coordinates"] == ["t", "x", "y"]
    (shape,) = line["ranges"]["wet"]["shape"]
    values = line["ranges"]["wet"]["values"]
    assert shape == len(values) == len(composite["values"]) > 300
    for (_, x, y), value in zip(composite["values"], values):
        assert abs(y - 0.03) < 1e-12
        if abs(abs(x - 0.02) - 0.01) > 2e-4:  # not at the edge of the disc
            assert value == (12.5 if abs(x - 0.02) < 0.01 else None), (x, value)
    area = ogc(
        server,
        "/collections/sheet/area",
        coords="POLYGON((0.01 0.01, 0.05 0.01, 0.05 0.05, 0.01 0.01))",
        **{"parameter-name": "units"},
    )
    axes, units = area["domain"]["axes"], area["ranges"]["units"]
    assert units["shape"] == [axes["y"]["num"], axes["x"]["num"]]
    step = [
        (axes[axis]["stop"] - axes[axis]["start"]) / (axes[axis]["num"] - 1) for axis in ("x", "y")
    ]
    inside = sum(value == 1 for value in units["values"])
    # The disc around (40, 40) with a radius of 30 mm contains the triangle, except near (10, 10).
    expected = 0.04 * 0.04 / 2 - corner_outside()
    assert abs(inside * step[0] * -step[1] / expected - 1) < 0.01, inside


def corner_outside():
    """Returns the area of the triangle outside the disc, counted on a fine grid, in m²."""
    count, steps = 0, 1000
    for i in range(steps):
        for k in range(steps):
            x, y = 10 + 40 * (i + 0.5) / steps, 10 + 40 * (k + 0.5) / steps
            count += y < x and math.dist((x, y), (40, 40)) > 30
    return count * (0.04 / steps) ** 2


def test_the_past_can_be_read(server):
    edits = server.ok("GET", "/models/sheet/layers/units/edits").json()["edits"]
    first, second = sorted(each["time"] for each in edits)
    ids = lambda when: [
        each["id"]
        for each in ogc(server, "/collections/sheet.units/items", datetime=when)["features"]
    ]
    assert ids(first) in ([], ["1"]) and ids(second) in (["1"], ["1", "2"])
    for when in ("2000-01-01T00:00:00Z/..", "2000-01-01T00:00:00Z/2999-01-01T00:00:00Z"):
        assert ids(when) == ["1", "2"], when
    assert ids("2000-01-01T00:00:00Z") == []
    past = {"datetime": "2000-01-01T00:00:00Z"}
    made = ogc(server, "/collections/sheet/position", coords="POINT(0.02 0.03)", **past)
    assert made["ranges"]["units"]["values"] == [None]


def test_other_directions_are_other_planes(server):
    side = ogc(server, "/collections/sheet.damage.sample", along="+y")
    assert side["crs"] == [f"{server.url}/ogc/crs/sheet/xz"]
    assert "along=%2By" in link(side, "items")["href"]
    place = ogc(server, "/collections/sheet.damage.sample/items", along="+y")["features"][0]
    assert place["geometry"]["coordinates"] == [0.08, 0]
    text = server.ok("GET", "//ogc/crs/sheet/xz").body.decode()
    done = subprocess.run(
        ["gdalsrsinfo", "-o", "wkt1", text], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0 and "LOCAL_CS" in done.stdout, (text, done)


def test_a_direction_stays_from_the_landing_page_to_the_features(server):
    landing = ogc(server, "", along="+y")
    follow = lambda href: server.ok("GET", "/" + href.removeprefix(server.url)).json()
    listed = follow(link(landing, "data")["href"])["collections"]
    (sample,) = [each for each in listed if each["id"] == "sheet.damage.sample"]
    assert sample["crs"] == [f"{server.url}/ogc/crs/sheet/xz"]
    alone = follow(link(sample, "self")["href"])
    assert alone["crs"] == sample["crs"]
    assert follow(link(alone, "self")["href"])["crs"] == sample["crs"]
    items = follow(link(alone, "items")["href"])
    assert items["features"][0]["geometry"]["coordinates"] == [0.08, 0]
    assert follow(link(items, "collection")["href"])["crs"] == sample["crs"]
    page = server.ok("GET", "//ogc/collections/sheet?f=html&along=%2By").body.decode()
    assert "along=%2By&amp;f=html" in page, page


def test_a_system_whose_register_has_the_northing_first(server):
    server.ok("PATCH", "/models/field", {"crs": "EPSG:31467"})
    plane = {"crs": "EPSG:31467"}
    corner = ogc(server, "/collections/field.pits/items", **plane)["features"][0]["geometry"]
    north, east = corner["coordinates"][0][0][0]
    assert abs(math.dist((east, north), (EAST + 30, NORTH + 60)) - 10) < 0.2
    found = ogc(
        server,
        "/collections/field/position",
        coords=f"POINT({NORTH + 60} {EAST + 30})",
        **plane,
    )
    assert found["ranges"]["pits"]["values"] == [1]
    axes = found["domain"]["axes"]
    assert (axes["x"]["values"], axes["y"]["values"]) == ([EAST + 30], [NORTH + 60])
    assert found["domain"]["referencing"][0]["coordinates"] == ["y", "x"]
    grid = ogc(server, "/collections/field.pits/coverage", f="covjson", width=10)["domain"]
    assert grid["axes"]["x"]["start"] == EAST + 5 and grid["axes"]["y"]["start"] == NORTH + 95
    assert grid["referencing"][0]["coordinates"] == ["y", "x"]
    for epsg, system in (("EPSG:2053", "xy"), ("EPSG:25832", None)):
        server.ok("PATCH", "/models/field", {"crs": epsg})
        systems = ogc(server, "/collections/field.pits")["crs"]
        local = [f"{server.url}/ogc/crs/field/{system}"]
        assert systems == (local if system else [CRS84, UTM]), systems


def test_a_member_of_one_project_sees_its_collections(server):
    server.ok("POST", "/projects", {"name": "Elsewhere"})
    gina = Someone(server, "gina", "guest")
    collections = lambda: gina.ok("GET", "//ogc/collections").json()["collections"]
    assert collections() == []
    assert gina.request("GET", "//ogc/collections/sheet").status == 404
    server.ok("PUT", "/projects/default/members/gina", {"role": "viewer"})
    for path in ("", "/conformance"):
        gina.ok("GET", "//ogc" + path)
    assert "sheet.units" in [each["id"] for each in collections()]
    gina.ok("GET", "//ogc/collections/sheet.units/items")


def test_refusals(server):
    for path, status, field in (
        ("sheet.units/items?limit=0", 400, "limit"),
        ("sheet.units/items?limit=many", 400, "limit"),
        ("sheet.units/items?bbox=1,2,3", 400, "bbox"),
        ("sheet.units/items?bbox=3,0,1,1", 400, "bbox"),
        ("sheet.units/items?bbox=0,0,1,nan", 400, "bbox"),
        ("sheet.units/items?datetime=yesterday", 400, "datetime"),
        ("sheet.units/items?datetime=2026-01-02/2026-01-01", 400, "datetime"),
        ("sheet.units/items?crs=EPSG:25832", 400, "crs"),
        ("field.pits/items?crs=EPSG:25833", 400, "crs"),
        ("sheet.units/items?along=up", 400, "along"),
        ("sheet.units/items?f=shp", 400, "f"),
        ("sheet.units/items?colour=red", 400, "colour"),
        ("sheet.units?f=xml", 400, "f"),
        ("sheet.units/coverage?scale-factor=0", 400, "scale-factor"),
        ("sheet.units/coverage?scale-factor=0.0001", 400, "scale-factor"),
        ("sheet.units/coverage?scale-size=x(9),q(9)", 400, "scale-size"),
        ("sheet.units/coverage?scale-size=x(9),x(9)", 400, "scale-size"),
        ("sheet.units/coverage?width=1e9", 400, "width"),
        ("sheet.units/coverage?width=16000000", 400, "width"),
        ("sheet.units/coverage?scale-size=x(1.5)", 400, "scale-size"),
        ("sheet.units/coverage?subset=x(2:3)", 400, "subset"),
        ("sheet.units/coverage?subset=x", 400, "subset"),
        ("sheet.units/coverage?subset=x(a:b)", 400, "subset"),
        ("sheet.units/coverage?bbox=5,5,6,6", 400, "bbox"),
        ("sheet.units/coverage?f=png", 400, "f"),
        ("sheet/position", 400, "coords"),
        ("sheet/position?coords=POINT(1", 400, "coords"),
        ("sheet/position?coords=LINESTRING(0%200,1%201)", 400, "coords"),
        ("sheet/position?coords=POINT(0%200)&parameter-name=nothing", 400, "parameter-name"),
        ("sheet/trajectory?coords=POINT(0%200)", 400, "coords"),
        ("sheet/area?coords=POLYGON((5%205,6%205,6%206,5%205))", 400, "coords"),
        ("field/position?coords=POINT(1000%201000)", 400, "coords"),
        ("field/area?coords=POLYGON((0%200,1%200,1%201,0%200))&crs=CRS84", 400, "crs"),
    ):
        answer = server.get("//ogc/collections/" + path)
        assert (answer.status, answer.json().get("field")) == (status, field), (path, answer)
    for path in (
        "nothing",
        "nothing.units",
        "sheet.nothing",
        "sheet.nothing/items",
        "sheet.units/items/9",
        "sheet.damage.code",
        "sheet.damage.code/items",
        "sheet.damage.nothing/items",
        "sheet.units.x.y",
    ):
        assert server.get("//ogc/collections/" + path).status == 404, path
    assert server.get("//ogc/crs/sheet/zz").status == 404
    assert server.get("//ogc", token=False).status == 401


def test_a_token_can_be_the_password_of_a_read(server):
    def status(method, path, secret):
        header = {"Authorization": "Basic " + base64.b64encode(secret.encode()).decode()}
        return server.request(method, path, {} if method == "POST" else None, header, False).status

    assert status("GET", "//ogc/collections", f"anybody:{server.token}") == 200
    for secret in (f"anybody:{server.token}x", server.token, "anybody:", f"{server.token}:"):
        assert status("GET", "//ogc/collections", secret) == 401, secret
    # Browsers repeat such headers, so nothing can be changed with them.
    assert status("GET", "/models", f"anybody:{server.token}") == 401
    assert status("POST", "/projects", f"anybody:{server.token}") == 401
    for header in ("Basic", "Basic ?", "Basic  "):
        answer = server.request("GET", "//ogc", None, {"Authorization": header}, False)
        assert answer.status == 401, header


def test_who_sees_what(server):
    vera = server.add_person("vera", "viewer")
    path = "//ogc/collections/sheet.damage/items"
    mine = server.get(path).json()["features"][0]["properties"]
    hers = server.get(path, token=vera).json()["features"][0]["properties"]
    assert mine["secret"] == "grave" and "secret" not in hers and hers["code"] == "Loss"
    server.ok("PATCH", "/models/sheet/layers/damage", {"visibility": "private"})
    listed = server.get("//ogc/collections", token=vera).json()["collections"]
    assert not [each for each in listed if "damage" in each["id"]]
    for name in ("sheet.damage", "sheet.damage.crack"):
        for part in ("", "/items"):
            answer = server.get(f"//ogc/collections/{name}{part}", token=vera)
            assert answer.status == 404, (name, part, answer)
    values = server.get(
        query("//ogc/collections/sheet/position", coords="POINT(0.03 0.07)"), token=vera
    )
    assert "damage" not in values.json()["ranges"]


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
