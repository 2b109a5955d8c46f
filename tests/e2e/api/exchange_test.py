"""Data of a project for reports, spreadsheets and other programs: quantities, texels as lines,
workbooks, vertices."""
import csv
import datetime
import io
import math
import os
import socket
import urllib.parse

import pytest
from support.meshes import folded_grid
from support.ply import read_ply
from support.readings import dab
from support.strata_server import wait_for
from support.workbook import Workbook

XLSX = "application/vnd.openxmlformats-officedocument.spreadsheetml.sheet"
M = "/models/sheet"  # a nearly flat sheet, x and y from 0 to 100 mm


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), (a, b)


def rows_of(answer, separator=","):
    text = answer.body.decode("utf-8-sig")
    return list(csv.DictReader(io.StringIO(text, newline=""), delimiter=separator))


def new_layer(server, body, model=M):
    return (
        f"{model}/layers/"
        + server.ok("POST", model + "/layers", {"resolution": 2048, **body}).json()["slug"]
    )


@pytest.fixture(scope="module")
def server(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    return server


def test_quantities_of_records(server, story):
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Pieces", "columns": [{"name": "Code", "required": True, "unique": True}]},
    )
    for code in ("Head", "=cmd|'/C calc'!A0", "Base, left"):
        server.ok("POST", "/tables/pieces/records", {"values": {"code": code}})
    pieces = new_layer(
        server, {"name": "Pieces", "kind": "database", "type": "u16", "table": "pieces"}
    )
    first = dab(server, pieces, 1, 30, 30, 10)["sequence"]
    dab(server, pieces, 2, 70, 30, 5)
    dab(server, pieces, 2, 70, 70, 5)
    now = server.get(pieces + "/quantities").json()
    keys = {k["key"]: k for k in server.get(pieces + "/statistics?include=pieces").json()["keys"]}
    assert [(q["class"], q["key"], q["pieces"]) for q in now["quantities"]] == [
        ("Head", 1, 1),
        ("=cmd|'/C calc'!A0", 2, 2),
    ], now
    for quantity in now["quantities"]:
        near(quantity["area_m2"], keys[quantity["key"]]["area_m2"], 1e-9)
        assert (
            quantity["texels"] == keys[quantity["key"]]["texels"]
            and quantity["pieces"] == keys[quantity["key"]]["pieces"]
        )
        near(quantity["share"], quantity["area_m2"] / server.get(M).json()["area_m2"], 1e-3)
    near(now["sum"]["area_m2"], 150 * math.pi * 1e-6, 0.02)
    assert now["sum"]["pieces"] == 3 and now["total"] == 2, now

    # the quantities of an earlier time have the names of that time
    server.ok("PATCH", "/tables/pieces/records/1", {"values": {"code": "Skull"}})
    assert server.get(pieces + "/quantities").json()["quantities"][0]["class"] == "Skull"
    past = server.get(f"{pieces}/quantities?at={first}")
    assert past.headers["Strata-Sequence"] == str(first)
    assert [q["class"] for q in past.json()["quantities"]] == ["Head"], past.json()

    rows = rows_of(server.get(pieces + "/quantities?f=csv"))
    assert [row["class"] for row in rows] == ["Skull", "'=cmd|'/C calc'!A0", "total"], rows
    assert float(rows[0]["area_m2"]) == now["quantities"][0]["area_m2"] and rows[2]["key"] == ""
    near(
        sum(float(row["percent_of_surface"]) for row in rows[:2]),
        float(rows[2]["percent_of_surface"]),
        1e-9,
    )
    other = rows_of(server.get(pieces + "/quantities?f=csv&separator=semicolon"), ";")
    assert other[0]["area_m2"] == rows[0]["area_m2"].replace(".", ","), other
    accepted = server.get(pieces + "/quantities", headers={"Accept": "text/csv"})
    assert (
        accepted.headers["Content-Type"].startswith("text/csv")
        and accepted.headers["Vary"] == "Accept"
    )
    for query, status, field in (
        ("f=ods", 406, "f"),
        ("separator=dot", 422, "separator"),
        ("at=99999", 422, "at"),
    ):
        answer = server.get(f"{pieces}/quantities?{query}")
        assert (answer.status, answer.json()["field"]) == (status, field), answer
    story.pieces = pieces


def test_quantities_of_numbers(server):
    palette = {"mode": "categorical", "points": [{"at": 3, "color": "#ff0000", "label": "Salt"}]}
    salt = new_layer(server, {"name": "Salt", "type": "i8", "palette": palette})
    assert server.get(salt + "/quantities").json()["quantities"] == []
    dab(server, salt, 3, 30, 30, 10)
    dab(server, salt, -2, 70, 70, 10)
    assert [
        (q["class"], q["value"]) for q in server.get(salt + "/quantities").json()["quantities"]
    ] == [("-2", -2), ("Salt", 3)]
    rows = rows_of(server.get(salt + "/quantities?f=csv"))
    assert [(row["class"], row["value"]) for row in rows] == [
        ("-2", "-2"),
        ("Salt", "3"),
        ("total", ""),
    ], rows

    steps = {
        "mode": "step",
        "points": [
            {"at": 0.1, "color": "#00ff00", "label": "dry"},
            {"at": 0.5, "color": "#0000ff", "label": "wet"},
        ],
    }
    moisture = new_layer(server, {"name": "Moisture", "type": "f32", "palette": steps})
    for value, x in ((0.05, 15), (0.2, 40), (0.3, 45), (0.7, 80)):
        dab(server, moisture, value, x, 50, 10)
    now = server.get(moisture + "/quantities").json()["quantities"]
    assert [(q["class"], q.get("from"), q.get("to"), q["pieces"]) for q in now] == [
        ("below 0.1", None, 0.1, 1),
        ("dry", 0.1, 0.5, 1),
        ("wet", 0.5, None, 1),
    ], now
    for quantity, where in zip(
        now, ("moisture < 0.1", "moisture >= 0.1 and moisture < 0.5", "moisture >= 0.5")
    ):
        near(
            quantity["area_m2"],
            server.ok("POST", M + "/select", {"where": where}).json()["area_m2"],
            1e-6,
        )
    linear = {
        "mode": "linear",
        "points": [
            {"at": 0, "color": "#000000"},
            {"at": 0.25, "color": "#888888"},
            {"at": 0.7, "color": "#ffffff"},
        ],
    }
    etag = server.get(moisture).headers["ETag"]
    server.ok("PATCH", moisture, {"palette": linear}, headers={"If-Match": etag})
    rows = rows_of(server.get(moisture + "/quantities?f=csv"))
    # 0.7 as a 32-bit float is less than 0.7 as a double
    assert [(row["class"], row["from"], row["to"]) for row in rows] == [
        ("from 0 to 0.25", "0", "0.25"),
        ("from 0.25 to 0.7", "0.25", "0.7"),
        ("total", "", ""),
    ], rows


def test_workbooks(server, story):
    pieces = story.pieces
    columns = [
        {"name": "Code", "required": True, "unique": True},
        {"name": "Depth", "kind": "numeric"},
        {"name": "Count", "kind": "integer"},
        {"name": "Loose", "kind": "boolean"},
        {"name": "Found", "kind": "date"},
        {"name": "Seen", "kind": "timestamp"},
        {"name": "Period", "kind": "period"},
        {"name": "Note"},
    ]
    server.ok("POST", "/projects/default/tables", {"name": "Finds", "columns": columns})
    hostile = "=cmd|'/C calc'!A0"
    long = "\N{AMPHORA}" * 20000  # each character has two units in UTF-16
    escapes = "two\nlines\r\n \u0001 <&> \uffff 'quoted' _x0041__x005F_x0041_ _x00e_ __x000D_x000d_ _X0041_ _x000D\r _x0041\uffff _x00G0_ _x12"
    made = [
        {
            "code": "A",
            "depth": -1.25,
            "count": 2**53,
            "loose": True,
            "found": "2024-02-29",
            "seen": "2024-05-02T12:34:56.789+02:00",
            "period": "1560~",
            "note": hostile,
        },
        {"code": "+B", "loose": False, "found": "1066-10-14", "note": escapes},
        {"code": "@C", "depth": 1e-7, "note": long},
        {"code": "_x000D_", "note": "_x000d_" * 5000},
    ]
    server.ok("POST", "/tables/finds/records", {"records": [{"values": values} for values in made]})
    answer = server.get("/tables/finds/records?f=xlsx")
    assert answer.headers["Content-Type"] == XLSX and answer.headers[
        "Content-Disposition"
    ].endswith("finds.xlsx"), answer.headers
    book = Workbook(answer.body)
    assert (
        book.formulas == []
        and book.head_is_bold_and_stays()
        and book.filtered == "A1:I5"
        and book.sheet_name == "finds"
    ), book.filtered
    assert book.rows[0] == [
        "key",
        "code",
        "depth",
        "count",
        "loose",
        "found",
        "seen",
        "period",
        "note",
    ]
    first, second, third, fourth = book.records
    assert first == {
        "key": 1.0,
        "code": "A",
        "depth": -1.25,
        "count": float(2**53),
        "loose": True,
        "found": datetime.date(2024, 2, 29),
        "seen": datetime.datetime(2024, 5, 2, 10, 34, 56, 789000),
        "period": "1560~",
        "note": hostile,
    }, first
    assert (second["code"], second["loose"], second["found"], second["depth"]) == (
        "+B",
        False,
        "1066-10-14",
        None,
    ), second
    assert second["note"] == escapes, second["note"]
    assert fourth["code"] == "_x000D_" and set(fourth["note"].split("_x000d_")) == {
        "",
        "\u2026",
    }, fourth["note"][-50:]
    assert third["depth"] == 1e-7 and third["note"] == "\N{AMPHORA}" * 16383 + "\u2026", (
        third["depth"],
        len(third["note"]),
    )
    some = Workbook(
        server.get(
            "/tables/finds/records?filter=depth%20%3C%200&sortby=-code", headers={"Accept": XLSX}
        ).body
    )
    assert [record["code"] for record in some.records] == ["A"]

    on_layer = Workbook(server.get(pieces + "/records?f=xlsx&sortby=-area_m2").body).records
    areas = {
        q["key"]: q["area_m2"] for q in server.get(pieces + "/quantities").json()["quantities"]
    }
    assert [r["key"] for r in on_layer] == [1, 2, 3] and on_layer[2]["area_m2"] == on_layer[2][
        "area (cm²)"
    ] == 0, on_layer
    near(on_layer[0]["area_m2"], areas[1], 1e-12)
    near(on_layer[0]["area (cm²)"], 1e4 * areas[1], 1e-12)

    book = Workbook(server.get(pieces + "/quantities?f=xlsx").body)
    expected = rows_of(server.get(pieces + "/quantities?f=csv"))
    assert (
        book.formulas == []
        and book.filtered == "A1:G3"
        and "#,##0.000" in book.codes.values()
        and len(book.records) == 3
    ), book.filtered
    for row, written in zip(book.records, expected):
        for head in ("pieces", "texels", "area_m2", "percent_of_surface", "area (cm²)"):
            near(row[head], float(written[head]), 1e-15)  # a workbook stores 16 digits
        near(row["area (cm²)"], 1e4 * float(written["area_m2"]), 1e-15)
    assert [row["class"] for row in book.records] == ["Skull", hostile, "total"]
    assert [
        row["class"]
        for row in Workbook(
            server.get("/tables/pieces/quantities", headers={"Accept": XLSX}).body
        ).records
    ] == ["Skull", hostile, "total"]
    of_table = Workbook(server.get("/tables/pieces/quantities?f=xlsx").body)
    assert of_table.rows[0][4:] == [
        "area_m2",
        "sheet/pieces area_m2",
        "area (cm²)",
        "sheet/pieces area (cm²)",
    ], of_table.rows[0]
    cross = {"rows": "pieces", "columns": "pieces"}
    text = server.ok("POST", M + "/cross-table?f=csv", cross).body.decode("utf-8-sig")
    book = Workbook(server.ok("POST", M + "/cross-table?f=xlsx", cross).body)
    assert (
        text.startswith('"Pieces / Pieces, cm²",') and book.rows[0][0] == "Pieces / Pieces, cm²"
    ), (text, book.rows)
    near(book.rows[-1][-1], 1e4 * (areas[1] + areas[2]), 1e-12)
    # the server removes the file after the response
    wait_for(lambda: os.listdir(os.path.join(server.data, "uploads")) == [], "that nothing stays")


def lines_of(server, path, **query):
    answer = server.ok("GET", f"{path}/texels.csv?" + urllib.parse.urlencode(query))
    assert (
        answer.headers["Transfer-Encoding"] == "chunked"
        and answer.headers["Content-Type"] == "text/csv; charset=utf-8"
    )
    return rows_of(answer)


def aggregated(rows, edge, keys):
    """The reference for `cell`: returns {cell: (centroid, area, value)} for lines of texels."""
    cells = {}
    for row in rows:
        place, area = [float(row[axis]) for axis in "xyz"], float(row["area_m2"])
        cell = cells.setdefault(
            tuple(math.floor(v / edge) for v in place), [0.0, [0.0] * 3, 0.0, {}]
        )
        cell[0] += area
        cell[1] = [old + area * new for old, new in zip(cell[1], place)]
        cell[2] += area * float(row["value"])
        cell[3][row["value"]] = cell[3].get(row["value"], 0.0) + area
    return {
        index: (
            [v / area for v in centre],
            area,
            max(by_key, key=by_key.get) if keys else value / area,
        )
        for index, (area, centre, value, by_key) in cells.items()
    }


def test_texel_lines(server, story):
    pieces = story.pieces
    moisture = M + "/layers/moisture"
    rows = lines_of(server, moisture)
    statistics = server.get(moisture + "/statistics").json()
    assert list(rows[0]) == ["x", "y", "z", "area_m2", "value"], rows[0]
    assert len(rows) == statistics["texels"], (len(rows), statistics["texels"])
    near(sum(float(row["area_m2"]) for row in rows), statistics["area_m2"], 1e-6)
    near(
        sum(float(row["area_m2"]) * float(row["value"]) for row in rows) / statistics["area_m2"],
        statistics["mean"],
        1e-5,
    )
    some = rows[::997]
    points = server.ok(
        "POST",
        M + "/positions",
        {"points": [[float(row[a]) for a in "xyz"] for row in some], "layers": ["moisture"]},
    ).json()
    for row, point in zip(some, points["positions"]):
        assert point["distance"] < 1e-3 and point["values"]["moisture"]["valid"], (row, point)
        near(float(row["value"]), point["values"]["moisture"]["value"], 1e-6)

    wet = lines_of(
        server, moisture, where="moisture > 0.25 and pieces.code like '=%' or moisture < 0.1"
    )
    known = {(row["x"], row["y"], row["z"]): row["value"] for row in rows}
    assert 0 < len(wet) < len(rows) and all(
        known[row["x"], row["y"], row["z"]] == row["value"] for row in wet
    )
    assert {row["value"] for row in wet} <= {"0.05", "0.3", "0.7"}, {row["value"] for row in wet}

    # Omits texels that are close to the side of a cell, because rounded positions may be in the
    # next cell.
    inside = (
        "abs(z) > 0.0002 and x % 5 between 0.0002 and 4.9998 and y % 5 between 0.0002 and 4.9998"
    )
    clear = lines_of(server, moisture, where=inside)
    assert len(clear) > 0.9 * len(rows)
    for text, edge in (("5mm", 5.0), ("2.5 cm", 25.0), ("1m", 1000.0)):
        expected = aggregated(clear, edge, False)
        cells = lines_of(server, moisture, cell=text, where=inside)
        assert len(cells) == len(expected)
        for row in cells:
            centre, area, value = expected[
                tuple(math.floor(float(row[axis]) / edge) for axis in "xyz")
            ]
            near(float(row["area_m2"]), area, 1e-6)
            near(float(row["value"]), value, 1e-5)
            assert max(abs(float(row[axis]) - at) for axis, at in zip("xyz", centre)) < 2e-3, (
                row,
                centre,
            )

    # keys are never mixed, and the lines have the values of their records
    rows = lines_of(server, pieces, columns="code", where="abs(z) > 0.0002")
    assert {(row["value"], row["code"]) for row in rows} == {
        ("1", "Skull"),
        ("2", "'=cmd|'/C calc'!A0"),
    }
    expected = aggregated(rows, 100.0, True)
    cells = lines_of(server, pieces, cell="10cm", columns="code", where="abs(z) > 0.0002")
    assert sorted(row["value"] for row in cells) == sorted(
        value for _, _, value in expected.values()
    ), (cells, expected)
    past = server.get(pieces + "/edits").json()["edits"][-1]["sequence"]
    assert {row["code"] for row in lines_of(server, pieces, columns="code", at=past)} == {"Head"}
    assert lines_of(server, pieces, at=0) == []
    other = rows_of(server.get(pieces + "/texels.csv?separator=semicolon&cell=1m"), ";")
    assert "," in other[0]["area_m2"], other

    for query, field in (
        ("cell=5", "cell"),
        ("cell=0mm", "cell"),
        ("cell=-5mm", "cell"),
        ("cell=5mmm", "cell"),
        ("cell=nanmm", "cell"),
        ("cell=0.0001mm", "cell"),
        ("columns=code", "columns"),
        ("where=moisture%3E", "where"),
        ("separator=x", "separator"),
        ("at=99999", "at"),
    ):
        answer = server.get(f"{moisture}/texels.csv?{query}")
        assert answer.status == 422 and answer.json()["field"] == field, (query, answer)
    assert server.get(pieces + "/texels.csv?columns=depth").json()["field"] == "columns"
    assert server.request("PUT", moisture + "/texels.csv", b"x,y,z\n").status == 404

    # Sends another request on the same connection. HTTP/1.0 has no chunks, so the end of the
    # connection ends the response.
    link = server.connect()
    first = server.get(pieces + "/texels.csv", connection=link).body
    assert server.get(pieces + "/texels.csv", connection=link).body == first
    assert server.request("HEAD", pieces + "/texels.csv", connection=link).status == 200
    assert server.get(pieces, connection=link).status == 200
    link.close()
    with socket.create_connection((server.host, server.port)) as raw:
        raw.sendall(
            f"GET /api/v1{pieces}/texels.csv HTTP/1.0\r\nAuthorization: Bearer {server.token}\r\n\r\n".encode()
        )
        answer = b"".join(iter(lambda: raw.recv(65536), b""))
    head, _, body = answer.partition(b"\r\n\r\n")
    assert b"chunked" not in head and body == first, head


def test_vertices(server):
    answer = server.get(M + "/vertices.ply?layers=moisture,salt,pieces")
    assert answer.headers["Content-Disposition"].endswith("sheet.ply") and int(
        answer.headers["Content-Length"]
    ) == len(answer.body)
    vertices, faces, names = read_ply(answer.body)
    model = server.get(M).json()
    assert (len(vertices), len(faces)) == (model["vertices"], model["triangles"]), model
    assert names == [
        "x",
        "y",
        "z",
        "moisture",
        "moisture_valid",
        "salt",
        "salt_valid",
        "pieces",
        "pieces_valid",
    ], names
    asked = {
        "points": [[v["x"], v["y"], v["z"]] for v in vertices],
        "layers": ["moisture", "salt", "pieces"],
    }
    points = server.ok("POST", M + "/positions", asked).json()["positions"]
    painted = on_seams = 0
    for vertex, point in zip(vertices, points):
        assert point["distance"] < 1e-4, point
        for layer in ("moisture", "salt", "pieces"):
            value = point["values"][layer]
            # at a seam the texel at this position is on the other side
            if vertex[layer + "_valid"] and not value["valid"]:
                on_seams += 1
                continue
            assert vertex[layer + "_valid"] == value["valid"], (vertex, value)
            assert vertex[layer] == (value["value"] if value["valid"] else 0), (vertex, value)
            painted += value["valid"]
    assert painted > 10 and on_seams < painted / 5, (painted, on_seams)
    # the server imports its own file, and reads the layers' values as numbers of the vertices
    again = server.import_model(answer.body, "again.ply", name="Again", unit="mm")
    assert (again["vertices"], again["triangles"]) == (model["vertices"], model["triangles"])
    near(again["area_m2"], model["area_m2"], 1e-6)
    nothing, _, names = read_ply(server.get(M + "/vertices.ply?layers=moisture&at=0").body)
    assert names[3:] == ["moisture", "moisture_valid"] and not any(
        vertex["moisture_valid"] for vertex in nothing
    )
    taken = new_layer(server, {"name": "red", "type": "i16"})
    assert read_ply(server.get(M + "/vertices.ply?layers=red").body)[2][3:] == [
        "layer_red",
        "layer_red_valid",
    ]
    server.ok("DELETE", taken)
    for query, status, field in (
        ("layers=nothing", 404, "layers"),
        ("layers=salt,salt", 422, "layers"),
        ("at=99999", 422, "at"),
    ):
        answer = server.get(f"{M}/vertices.ply?{query}")
        assert (answer.status, answer.json()["field"]) == (status, field), (query, answer)


def test_quantities_of_a_table(server, story):
    """The areas of a record on two models are added together."""
    pieces = story.pieces
    other = server.import_model(
        folded_grid(fold=0.001, size=50.0), "small.ply", name="Small", unit="mm"
    )
    there = new_layer(
        server,
        {"name": "Pieces", "kind": "database", "type": "u8", "table": "pieces"},
        model=f"/models/{other['slug']}",
    )
    dab(server, there, 2, 20, 20, 4)
    dab(server, there, 3, 40, 40, 4)
    here = {q["key"]: q for q in server.get(pieces + "/quantities").json()["quantities"]}
    away = {q["key"]: q for q in server.get(there + "/quantities").json()["quantities"]}
    table = server.get("/tables/pieces/quantities").json()
    assert [q["key"] for q in table["quantities"]] == [1, 2, 3] and table["total"] == 3, table
    both = table["quantities"][1]
    near(both["area_m2"], here[2]["area_m2"] + away[2]["area_m2"], 1e-12)
    assert both["pieces"] == 3 and len(both["layers"]) == 2 and both["has_record"], both
    near(
        table["sum"]["area_m2"], sum(q["area_m2"] for q in [*here.values(), *away.values()]), 1e-12
    )
    areas = {a["key"]: a["area_m2"] for a in server.get("/tables/pieces/areas").json()["areas"]}
    assert set(areas) == {1, 2, 3}
    for quantity in table["quantities"]:
        near(quantity["area_m2"], areas[quantity["key"]], 1e-9)
    rows = rows_of(server.get("/tables/pieces/quantities?f=csv"))
    assert (
        rows[1]["sheet/pieces area_m2"]
        and rows[1]["small/pieces area_m2"]
        and rows[0]["small/pieces area_m2"] == ""
    ), rows
    near(float(rows[3]["small/pieces area_m2"]), sum(q["area_m2"] for q in away.values()), 1e-12)


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
