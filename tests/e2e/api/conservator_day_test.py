"""A conservator's working day over HTTP, with only Python's standard library, as an example for
readers. The day has two walls of a chapel, a list of terms, and places with photos on both walls.
The conservator paints strokes, sends queries, computes a risk, and lists quantities for the report.
The test compares every number with the painted areas.

`server.ok(method, path, body)` sends a request to /api/v1 with the token. It sends a dict as JSON.
`story` contains the results of earlier steps."""
import csv
import io
import math
import urllib.parse

from support.cameras import camera_from
from support.meshes import folded_grid
from support.pictures import png
from support.workbook import Workbook

# nearly flat sheets, x and y from 0 to 100 mm
NORTH, SOUTH = "/models/north-wall", "/models/south-wall"
TERMS = """@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
<urn:damage:loss> a skos:Concept ; skos:notation "loss" ; skos:prefLabel "Loss"@en, "Pérdida"@es .
<urn:damage:flaking> a skos:Concept ; skos:notation "flaking" ; skos:prefLabel "Flaking"@en ; skos:broader <urn:damage:loss> .
<urn:damage:salts> a skos:Concept ; skos:notation "salts" ; skos:prefLabel "Salts"@en ; skos:definition "White, loose or crusty."@en .
""".encode()
MORE_TERMS = "code,label-es\nflaking,Descamación\nsalts,Sales\n".encode()


def disc(radius_mm):
    return math.pi * radius_mm**2 * 1e-6


def swept(radius_mm, length_mm):
    return disc(radius_mm) + 2 * radius_mm * length_mm * 1e-6


def near(value, expected, share=0.02):
    assert abs(value - expected) <= share * abs(expected), (value, expected)


def paint(server, model, layer, value, x, y, radius):
    """Paints a disc around a point on the wall."""
    path = f"{model}/layers/{layer}/readings?" + urllib.parse.urlencode({"radius_mm": radius})
    return server.ok(
        "POST", path, f"x,y,z,value\n{x},{y},0,{value}\n", headers={"Content-Type": "text/csv"}
    ).json()


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text.decode("utf-8-sig"))))


def test_the_site_is_set_up(server, story):
    """At nine o'clock: sets up the scans, the terms and the tables."""
    server.ok("POST", "/projects", {"name": "Chapel"})
    for name in ("North wall", "South wall"):
        server.import_model(
            folded_grid(fold=0.001), "wall.ply", name=name, unit="mm", project="chapel"
        )
    report = server.ok(
        "POST",
        "/projects/chapel/terms?name=Damage",
        TERMS,
        headers={"Content-Type": "text/turtle"},
        expect=(201,),
    ).json()
    assert report["created"] == 3, report
    changed = server.ok(
        "POST", "/tables/damage/terms", MORE_TERMS, headers={"Content-Type": "text/csv"}
    ).json()
    assert (changed["created"], changed["changed"]) == (0, 2), changed
    tree = server.ok("GET", "/tables/damage/terms?lang=es").json()["terms"]
    keys = {term["code"]: term["key"] for term in tree}
    names = {term["code"]: term["name"] for term in tree}
    assert names == {"loss": "Pérdida", "flaking": "Descamación", "salts": "Sales"}, tree
    found = server.ok("GET", "/tables/damage/terms?q=descam").json()["terms"]
    assert [term["code"] for term in found] == [
        "loss",
        "flaking",
    ], "what is looked for, below what it belongs to"
    server.ok(
        "POST",
        "/projects/chapel/tables",
        {
            "name": "Places",
            "columns": [
                {"name": "Name", "required": True, "unique": True},
                {"name": "Damage", "kind": "term", "target": "damage"},
                {"name": "Depth", "kind": "numeric", "unit": "mm"},
                {"name": "Urgency", "kind": "enumeration", "choices": ["watch", "now"]},
                {"name": "Seen", "kind": "date"},
                {"name": "Photos", "kind": "picture"},
            ],
        },
    )
    for model in (NORTH, SOUTH):
        server.ok(
            "POST",
            model + "/layers",
            {
                "name": "Damage",
                "kind": "database",
                "type": "u16",
                "table": "damage",
                "resolution": 2048,
            },
        )
        server.ok(
            "POST",
            model + "/layers",
            {
                "name": "Places",
                "kind": "database",
                "type": "u16",
                "table": "places",
                "resolution": 2048,
            },
        )
        server.ok(
            "POST",
            model + "/layers",
            {"name": "Moisture", "type": "f32", "unit": "%", "resolution": 2048},
        )
    story.keys = keys


def test_look_and_paint(server, story):
    """Until noon: paints the observations at the walls."""
    keys = story.keys
    paint(server, NORTH, "damage", keys["flaking"], 30, 30, 12)
    paint(server, NORTH, "damage", keys["salts"], 70, 70, 10)
    paint(server, SOUTH, "damage", keys["flaking"], 50, 50, 20)
    # paints a crack along the foot of the wall with the brush, in pixels of a camera perpendicular
    # to the wall
    camera = camera_from(server.get(SOUTH).json(), (0, 0, 1), up=(0, 1, 0))
    distance = -camera["view"][14]
    mm_of_pixel = 2 * distance / camera["projection"][5] / camera["height"]
    y = camera["height"] / 2 + 40 / mm_of_pixel  # 40 mm below the middle of the image
    crack = {
        "op": "stroke",
        "value": keys["loss"],
        "camera": camera,
        "radius_mm": 2,
        "path": [[320 - 30 / mm_of_pixel, y], [320 + 30 / mm_of_pixel, y]],
    }
    near(server.ok("POST", SOUTH + "/layers/damage/edits", crack).json()["area_m2"], swept(2, 60))
    # paints one stroke too many and undoes it
    before = server.get(SOUTH + "/layers/damage/statistics").json()
    server.ok("POST", SOUTH + "/layers/damage/edits", {**crack, "radius_mm": 9})
    assert server.get(SOUTH + "/layers/damage/statistics").json()["keys"] != before["keys"]
    server.ok("POST", SOUTH + "/layers/damage/undo")
    assert server.get(SOUTH + "/layers/damage/statistics").json()["keys"] == before["keys"]
    places = [
        ("Apse", "flaking", 3, "now"),
        ("Door", "salts", 1, "watch"),
        ("Window", "flaking", 5, "watch"),
    ]
    for name, damage, depth, urgency in places:
        server.ok(
            "POST",
            "/tables/places/records",
            {
                "values": {
                    "name": name,
                    "damage": keys[damage],
                    "depth": depth,
                    "urgency": urgency,
                    "seen": "2024-05-02",
                }
            },
            expect=(201,),
        )
    paint(server, NORTH, "places", 1, 30, 30, 15)
    paint(server, NORTH, "places", 2, 70, 70, 8)
    paint(server, SOUTH, "places", 3, 50, 50, 20)
    paint(server, SOUTH, "places", 1, 15, 85, 5)  # the apse extends over both walls
    for percent, x, y, radius in ((10, 50, 50, 45), (40, 30, 30, 15), (80, 30, 30, 6)):
        paint(server, NORTH, "moisture", percent, x, y, radius)


def test_add_photos(server):
    """Matches a folder of photos to places by the file names."""
    names = ["apse_before_1.png", "door_before_1.png", "crypt_before_1.png"]
    match = server.ok(
        "POST",
        "/tables/places/attachments/match",
        {"pattern": "{name}_{view}_{n}.png", "column": "name", "names": names},
    ).json()
    assert [(each["name"], each["key"]) for each in match["matched"]] == [
        (names[0], 1),
        (names[1], 2),
    ], match
    assert [each["name"] for each in match["unmatched"]] == [names[2]], match
    for each in match["matched"]:
        picture = png(40, 30, lambda x, y, key=each["key"]: (60 * key, 100, 3 * y))
        server.ok(
            "POST",
            f"/tables/places/records/{each['key']}/attachments?"
            + urllib.parse.urlencode({"name": each["name"]}),
            picture,
            expect=(201,),
        )
    [photo] = server.ok("GET", "/tables/places/records/1/attachments").json()["attachments"]
    assert (photo["name"], photo["column"], photo["width"]) == (names[0], "photos", 40), photo
    assert (
        server.ok("GET", f"/attachments/{photo['id']}?thumbnail=64").headers["Content-Type"]
        == "image/jpeg"
    )


def test_ask(server, story):
    """In the afternoon: queries places, counts and areas."""
    keys = story.keys

    def found(text, path="/tables/places"):
        answer = server.ok(
            "GET", f"{path}/records?" + urllib.parse.urlencode({"filter": text})
        ).json()
        return {each["values"]["name"]: each.get("area_m2") for each in answer["records"]}

    assert set(found("damage.code = 'flaking' and depth > 2")) == {"Apse", "Window"}
    assert set(found("urgency = 'now' or seen < date('2024-01-01')")) == {"Apse"}
    near(found("urgency = 'now'", NORTH + "/layers/places")["Apse"], disc(15))
    near(
        server.ok(
            "POST",
            NORTH + "/select",
            {"where": "places.urgency = 'now' and damage.code = 'flaking' and moisture > 50"},
        ).json()["area_m2"],
        disc(6),
        0.03,
    )
    extent = server.ok("POST", SOUTH + "/layers/places/extent", {"filter": "depth > 2"}).json()
    near(extent["area_m2"], disc(20) + disc(5))
    # the apse is one place on both walls
    table = server.ok("GET", "/tables/places/quantities").json()
    areas = {each["key"]: each["area_m2"] for each in table["quantities"]}
    near(areas[1], disc(15) + disc(5))
    near(areas[3], disc(20))
    # the area of each place, in m²
    cross = server.ok(
        "POST", NORTH + "/cross-table", {"rows": "damage", "columns": "places"}
    ).json()
    flaking, salts = cross["rows"].index(keys["flaking"]), cross["rows"].index(keys["salts"])
    apse, door = cross["columns"].index(1), cross["columns"].index(2)
    near(cross["area_m2"][flaking][apse], disc(12))
    near(cross["area_m2"][salts][door], disc(8), 0.03)
    assert cross["area_m2"][flaking][door] == 0, cross


def test_weigh(server):
    """A computed risk depends on the observations."""
    expression = "if(places.urgency = 'now', 2, 1) * reclass(moisture, 0, 30, 1, 60, 2)"
    risk = server.ok(
        "POST",
        NORTH + "/layers",
        {"name": "Risk", "expression": expression, "type": "u8", "resolution": 2048},
        expect=(201,),
    ).json()
    assert risk["inputs"] == ["moisture", "places"] and not risk["stale"], risk
    near(
        server.ok("POST", NORTH + "/select", {"where": "risk = 4"}).json()["area_m2"], disc(6), 0.03
    )
    near(
        server.ok("POST", NORTH + "/select", {"where": "risk = 2"}).json()["area_m2"],
        disc(15) - disc(6),
        0.03,
    )
    then = server.get(NORTH + "/layers/risk").json()["sequence"]
    server.ok("PATCH", "/tables/places/records/1", {"values": {"urgency": "watch"}})
    assert server.get(NORTH + "/layers/risk").json()["stale"]
    server.ok("POST", NORTH + "/layers/risk/compute")
    near(
        server.ok("POST", NORTH + "/select", {"where": "risk = 2"}).json()["area_m2"], disc(6), 0.03
    )
    near(
        server.ok("POST", NORTH + "/select", {"where": "risk = 4", "at": then}).json()["area_m2"],
        disc(6),
        0.03,
    )
    server.ok("POST", "/tables/places/undo")
    # the image for the report shows only the urgent places, hatched and colored by urgency
    server.ok(
        "PATCH",
        NORTH + "/layers/places",
        {
            "palette": {
                "mode": "categorical",
                "column": "urgency",
                "points": [
                    {
                        "at": 0,
                        "value": "now",
                        "color": "#d55e00",
                        "pattern": "hatch",
                        "spacing_mm": 2,
                    },
                    {"at": 1, "value": "watch", "color": "#56b4e9"},
                ],
            }
        },
    )
    camera = camera_from(server.get(NORTH).json(), (0, 0, 1), up=(0, 1, 0))
    highlight = [{"layer": "places", "highlight": {"filter": "urgency = 'now'", "isolate": True}}]
    pictures = [
        server.ok(
            "POST",
            NORTH + "/frame",
            {"camera": camera, "layers": ["places"], "format": "png", **more},
        ).body
        for more in ({}, {"highlights": highlight})
    ]
    assert pictures[0] != pictures[1] and all(each.startswith(b"\x89PNG") for each in pictures)


def test_report(server, story):
    """Before six o'clock: reads the numbers for the report."""
    keys = story.keys
    answer = server.ok("GET", NORTH + "/layers/damage/quantities").json()
    by_class = {each["key"]: each for each in answer["quantities"]}
    near(by_class[keys["flaking"]]["area_m2"], disc(12))
    near(by_class[keys["salts"]]["area_m2"], disc(10))
    assert (
        by_class[keys["flaking"]]["pieces"] == 1 and by_class[keys["flaking"]]["class"] == "Flaking"
    ), by_class
    near(answer["sum"]["area_m2"], disc(12) + disc(10))
    near(answer["sum"]["share"], (disc(12) + disc(10)) / 0.01)
    lines = rows_of(server.ok("GET", NORTH + "/layers/damage/quantities?f=csv").body)
    assert (
        lines[-1]["class"] == "total"
        and abs(float(lines[-1]["area_m2"]) - answer["sum"]["area_m2"]) < 1e-12
    ), lines
    book = Workbook(server.ok("GET", NORTH + "/layers/damage/quantities?f=xlsx").body)
    assert [each["class"] for each in book.records] == [
        "Flaking",
        "Salts",
        "total",
    ] and book.records[0]["pieces"] == 1, book.records
    near(book.records[2]["area (cm²)"], 1e4 * answer["sum"]["area_m2"], 1e-12)
    [crack] = [
        each
        for each in server.ok("GET", SOUTH + "/layers/damage/quantities").json()["quantities"]
        if each["key"] == keys["loss"]
    ]
    near(crack["area_m2"], swept(2, 60))
    places = rows_of(server.ok("GET", "/tables/places/records?f=csv").body)
    assert [each["name"] for each in places] == ["Apse", "Door", "Window"] and places[2][
        "depth"
    ] == "5", places
    texels = rows_of(
        server.ok(
            "GET",
            NORTH
            + "/layers/moisture/texels.csv?"
            + urllib.parse.urlencode({"where": "moisture > 50", "cell": "5mm"}),
        ).body
    )
    near(sum(float(each["area_m2"]) for each in texels), disc(6), 0.03)


def test_tomorrow_all_of_it_is_there(server, story):
    before = server.ok("GET", "/tables/places/quantities").json()
    assert server.stop() == 0
    server.start()
    assert server.ok("GET", "/tables/places/quantities").json() == before
    test_report(server, story)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
