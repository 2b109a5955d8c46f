"""Data that analysts read with SQL: areas that agree with the statistics after every edit, tables
under their own names, and no other data."""
import csv
import io
import os
import socket
import stat
import subprocess

import pytest
from support.cameras import camera_from
from support.meshes import folded_grid
from support.sql_reader import Reader, free_port
from support.strata_server import StrataServer, wait_for

M = "/models/sheet"


def near(a, b, share):
    assert abs(a - b) <= share * abs(b), (a, b)


def check_areas(server, reader, model=M):
    """Checks every layer of the model, by key if it has keys, and in total."""
    for layer in server.get(model + "/layers").json()["layers"]:
        statistics = server.get(f"{model}/layers/{layer['id']}/statistics").json()
        rows = reader.rows(f"SELECT * FROM areas WHERE layer_id = {layer['id']}")
        assert sum(int(row["texels"]) for row in rows) == statistics["texels"], (
            layer["name"],
            rows,
            statistics,
        )
        if statistics["texels"]:
            near(sum(float(row["area_m2"]) for row in rows), statistics["area_m2"], 1e-9)
        if layer["kind"] != "database" and layer["type"] not in ("u8", "i8"):
            assert [row["key"] for row in rows] == ([""] if statistics["texels"] else []), rows
            continue
        assert {int(row["key"]) for row in rows} == {key["key"] for key in statistics["keys"]}, (
            layer["name"],
            rows,
        )
        by_key = {int(row["key"]): row for row in rows}
        for key in statistics["keys"]:
            row = by_key[key["key"]]
            assert int(row["texels"]) == key["texels"], (row, key)
            near(float(row["area_m2"]), key["area_m2"], 1e-9)
            for axis, name in enumerate("xyz"):
                for head, value in (
                    (f"centroid_{name}", key["centroid"][axis]),
                    (f"min_{name}", key["bounds"]["min"][axis]),
                    (f"max_{name}", key["bounds"]["max"][axis]),
                ):
                    assert abs(float(row[head]) - value) < 1e-6, (head, row, key)


@pytest.fixture(scope="module")
def port():
    return free_port()


@pytest.fixture(scope="module")
def server(port):
    with StrataServer(demo=True, options=["--sql-listen", f"127.0.0.1:{port}"]) as server:
        yield server


@pytest.fixture(scope="module")
def reader(server, port):
    assert stat.S_IMODE(os.stat(os.path.join(server.data, "sql-password")).st_mode) == 0o600
    return Reader(server, port)


def test_areas_of_a_project_from_before_sums_were_kept(server, reader):
    """The journal of the demo project's layers has no sums of areas. The running server computes
    these sums once."""
    wait_for(
        lambda: reader.rows("SELECT count(*) FROM layers WHERE NOT areas_current")[0]["count"]
        == "0",
        "all layers to be counted",
    )
    check_areas(server, reader, "/models/demo-pot")


@pytest.fixture(scope="module")
def sheet(server):
    server.import_model(folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm")
    server.ok(
        "POST",
        "/projects/default/tables",
        {"name": "Units", "columns": [{"name": "Code", "required": True, "unique": True}]},
    )
    server.ok(
        "POST",
        "/tables/units/records",
        {"records": [{"values": {"code": f"SU {n}"}} for n in (1, 2, 3)]},
    )


@pytest.mark.usefixtures("sheet")
def test_edits(server, reader):
    """After strokes, fills, erasing and undo, the areas immediately equal the areas of
    the statistics."""
    layers = {}
    for body in (
        {"name": "Marks", "type": "u8"},
        {"name": "Depth", "type": "f32"},
        {"name": "Level", "type": "u16"},
        {"name": "Signed", "type": "i8"},
        {"name": "Units", "kind": "database", "type": "u32", "table": "units"},
    ):
        layers[body["name"]] = (
            f"{M}/layers/"
            + server.ok("POST", M + "/layers", {"resolution": 2048, **body}).json()["slug"]
        )
    assert reader.rows("SELECT * FROM areas WHERE model = 'Sheet'") == []
    camera = camera_from(server.get(M).json(), (0, 0, 1), up=(0, 1, 0))
    stroke = {"op": "stroke", "camera": camera, "radius_px": 30, "path": [[200, 200], [400, 260]]}
    for name, value in (
        ("Marks", 7),
        ("Depth", 0.25),
        ("Level", 60000),
        ("Signed", -3),
        ("Units", 2),
    ):
        server.ok("POST", layers[name] + "/edits", {**stroke, "value": value})
        check_areas(server, reader)
    server.ok("POST", layers["Marks"] + "/edits", {**stroke, "value": 9, "path": [[300, 220]]})
    server.ok(
        "POST", layers["Marks"] + "/edits", {**stroke, "erase": True, "value": 0, "radius_px": 10}
    )
    check_areas(server, reader)
    server.ok(
        "POST",
        layers["Units"] + "/edits",
        {"op": "fill", "mode": "where", "where": "marks = 9", "value": 3},
    )
    server.ok("POST", layers["Marks"] + "/undo")
    check_areas(server, reader)
    server.ok(
        "POST",
        layers["Depth"] + "/edits",
        {"op": "fill", "mode": "where", "where": "true", "erase": True, "value": 0},
    )
    check_areas(server, reader)
    history = reader.rows(
        "SELECT \"user\", op, sequence, area_m2 FROM edits WHERE layer = 'Marks' ORDER BY sequence"
    )
    told = server.get(layers["Marks"] + "/edits").json()["edits"][::-1]
    assert [(row["op"], int(row["sequence"])) for row in history] == [
        (edit["op"], edit["sequence"]) for edit in told
    ], history
    # joins the records of a table with their areas; the areas do not depend on the unit of the
    # model
    joined = 'SELECT u."Code", a.area_m2 FROM areas a JOIN "Units" u USING (key) WHERE a.table_id = (SELECT table_id FROM tables WHERE "table" = \'Units\') ORDER BY key'
    before = reader.rows(joined)
    assert [row["Code"] for row in before] == ["SU 2", "SU 3"], before
    etag = server.get(M).headers["ETag"]
    server.ok("PATCH", M, {"unit": "cm"}, headers={"If-Match": etag})
    for old, new in zip(before, reader.rows(joined)):
        near(float(new["area_m2"]), 100 * float(old["area_m2"]), 1e-9)
    check_areas(server, reader)


def test_places(server, reader):
    """Analysts get positions as text, and may call the function that makes the text."""
    rows = reader.rows("SELECT * FROM areas WHERE model = 'Sheet'")
    assert rows and all(
        row["geometry_wkt"]
        == f"POINT Z ({row['centroid_x']} {row['centroid_y']} {row['centroid_z']})"
        and row["srid"] == ""
        for row in rows
    ), rows
    server.ok("PATCH", M, {"crs": "EPSG:25832"})
    assert {
        row["srid"]
        for row in reader.rows(
            "SELECT srid FROM areas WHERE model = 'Sheet' UNION SELECT srid FROM models WHERE model = 'Sheet'"
        )
    } == {"25832"}
    model = server.get(M).json()["id"]
    server.ok("POST", "/tables/units/columns", {"name": "Crack", "kind": "line"})
    server.ok(
        "PATCH",
        "/tables/units/records/1",
        {"values": {"crack": [{"model": model, "coordinates": [[1.5, 2, 3], [4, 5, 6]]}]}},
    )
    (row,) = reader.rows(
        f'SELECT "Crack (wkt)" AS all, wkt("Crack", {model}) AS here, wkt("Crack", {model + 1}) AS elsewhere FROM "Units" WHERE key = 1'
    )
    assert row == {
        "all": "MULTILINESTRING Z ((1.5 2.0 3.0, 4.0 5.0 6.0))",
        "here": row["all"],
        "elsewhere": "",
    }, row
    server.ok("DELETE", "/tables/units/columns/crack")
    assert "Crack (wkt)" not in columns(reader, "Units")
    server.ok("PATCH", M + "/layers/marks", {"labels": {"de": "Zeichen"}})
    assert reader.rows("SELECT labels ->> 'de' AS de FROM layers WHERE layer = 'Marks'") == [
        {"de": "Zeichen"}
    ]


def views(reader):
    return {row["table"]: row["view"] for row in reader.rows("SELECT * FROM tables")}


def columns(reader, view):
    return list(
        csv.reader(
            io.StringIO(
                reader.run('SELECT * FROM "' + view.replace('"', '""') + '" LIMIT 0').stdout
            )
        )
    )[0]


def test_tables(server, reader):
    long = "Überlänge " * 15 + "ist möglich"
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "areas",
            "slug": "clash",
            "columns": [{"name": "key"}, {"name": "Key"}, {"name": "Key", "slug": "key-again"}],
        },
    )
    hostile = 'x"; DROP TABLE public.tokens; --'
    made = server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": hostile,
            "slug": "hostile",
            "columns": [
                {"name": 'a" b'},
                {"name": long},
                {"name": long + "!"},
                {"name": "Since", "kind": "period"},
            ],
        },
    ).json()
    first, second, third, _ = made["columns"]
    names = views(reader)
    clash = server.get("/tables/clash").json()
    assert names["areas"] == f"areas (t{clash['id']})" and names[hostile] == hostile, names
    ids = [column["id"] for column in clash["columns"]]
    assert columns(reader, names["areas"]) == [
        "key",
        f"key (c{ids[0]})",
        "Key",
        f"Key (c{ids[2]})",
    ], columns(reader, names["areas"])
    shown = columns(reader, hostile)
    assert (
        shown[:2] == ["key", 'a" b']
        and shown[4] == "Since"
        and long.startswith(shown[2])
        and shown[3].endswith(f" (c{third['id']})")
    ), shown
    assert all(len(name.encode()) <= 63 for name in shown), shown
    server.ok(
        "POST", "/tables/hostile/records", {"values": {first["slug"]: "it's", "since": "1560~"}}
    )
    assert (
        reader.rows(f'SELECT * FROM "{hostile.replace(chr(34), chr(34) * 2)}"')[0]["Since"]
        == "1560~"
    )

    # An analyst's open table does not prevent changes by users.
    with subprocess.Popen(
        reader.command() + ["-At"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=reader.environment(),
    ) as session:
        session.stdin.write(
            f'BEGIN; SELECT count(*) FROM "{hostile.replace(chr(34), chr(34) * 2)}";\n'
        )
        session.stdin.flush()
        assert (
            session.stdout.readline().strip() == "BEGIN"
            and session.stdout.readline().strip() == "1"
        )
        server.ok("PATCH", f"/tables/hostile/columns/{first['id']}", {"name": "Plain"})
        server.ok("POST", "/tables/hostile/columns", {"name": "New", "kind": "numeric"})
        server.ok("DELETE", f"/tables/hostile/columns/{second['id']}")
        session.stdin.close()
        session.wait()
    server.ok("PATCH", "/tables/hostile", {"name": "Calm"})
    assert (
        columns(reader, "Calm")[:2] == ["key", "Plain"]
        and "New" in columns(reader, "Calm")
        and len(columns(reader, "Calm")) == 5
    )
    assert hostile not in views(reader).values()
    server.ok("POST", "/tables/hostile/undo")  # restores the dropped column
    assert len(columns(reader, "Calm")) == 6, columns(reader, "Calm")
    server.ok("DELETE", "/tables/hostile")
    assert "Calm" not in views(reader).values()
    reader.refused('SELECT * FROM "Calm"', why="does not exist")
    server.ok("DELETE", "/tables/clash")


def test_rights(reader):
    anyway = "SET default_transaction_read_only = off"
    for statement in (
        "DELETE FROM edits",
        "INSERT INTO projects VALUES (9, 'x', 'x', '')",
        "UPDATE models SET model = 'x'",
        "CREATE TABLE t (a int)",
        "CREATE TABLE public.t (a int)",
        "CREATE TABLE analysis.t (a int)",
        "CREATE TEMP TABLE t (a int)",
        "CREATE SCHEMA s",
        "SELECT lo_create(0)",
        "SELECT lo_from_bytea(0, 'x')",
        "SELECT pg_advisory_lock(1)",
        "COPY (SELECT 1) TO PROGRAM 'id'",
        "CREATE ROLE r",
        "ALTER ROLE strata_reader SUPERUSER",
    ):
        done = reader.run(anyway, statement)
        assert done.returncode != 0 and any(
            reason in done.stderr for reason in ("permission denied", "must be", "cannot")
        ), (statement, done.stderr)
    reader.refused("SELECT 1 INTO TEMP t", why="cannot execute")
    for secret in (
        "public.tokens",
        "public.users",
        "public.blobs",
        "public.blob_chunks",
        "public.answers",
        "public.tile_revisions",
        "records.t1",
        "pg_authid",
        "public.record_tables",
    ):
        reader.refused(f"SELECT * FROM {secret}", why="permission denied")
    reader.refused("SELECT pg_read_file('/etc/passwd')", why="permission denied")
    reader.refused(
        "SET statement_timeout = '50ms'", "SELECT pg_sleep(100)", why="statement timeout"
    )
    assert reader.rows("SHOW statement_timeout")[0]["statement_timeout"] == "30s"
    assert (
        reader.rows("SHOW default_transaction_read_only")[0]["default_transaction_read_only"]
        == "on"
    )
    assert (
        reader.rows(
            "SELECT count(*) FROM pg_stat_activity WHERE query <> '<insufficient privilege>' AND usename <> 'strata_reader'"
        )[0]["count"]
        == "0"
    )
    reader.refused(
        "SELECT 1", password="wrong-password-of-nobody", why="password authentication failed"
    )
    for other in ({"user": "strata"}, {"user": "postgres"}, {"database": "postgres"}):
        reader.refused("SELECT 1", **other, why="no pg_hba.conf entry")


def test_the_password_and_the_areas_are_kept_over_a_restart(server, reader, port):
    password = reader.password
    server.kill()
    server.start()
    assert Reader(server, port).password == password
    check_areas(server, reader)


def test_without_the_option_nobody_listens(server, port):
    assert server.stop() == 0
    server.options = []
    server.start()
    assert socket.socket().connect_ex(("127.0.0.1", port)) != 0
    assert server.stop() == 0
    server.assert_clean_log()


def test_command_line(server):
    binary = server.binary
    for listen, code, words in (
        ("0.0.0.0:5433", 1, "only loopback addresses"),
        ("127.0.0.1:0", 106, "port"),
        ("nonsense", 106, "HOST:PORT"),
    ):
        done = subprocess.run(
            [binary, "serve", "--data", "/nonexistent/x", "--sql-listen", listen],
            capture_output=True,
            text=True,
            check=False,
        )
        assert (
            done.returncode != 0 and words in done.stderr and (code == 1) == (done.returncode == 1)
        ), (listen, done.returncode, done.stderr)
    done = subprocess.run(
        [
            binary,
            "serve",
            "--data",
            "/nonexistent/x",
            "--database",
            "host=/nowhere",
            "--sql-listen",
            "127.0.0.1:5433",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1 and "docs/how-to/query-with-sql.md" in done.stderr, done.stderr
