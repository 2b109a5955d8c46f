"""pandas reads every CSV and XLSX file of the API as a table without corrections: rows, columns and
types."""
import io
import urllib.parse

import pytest
from support.meshes import folded_grid
from support.missing import missing

try:
    import openpyxl  # noqa: F401  (pandas reads XLSX with it)
    import pandas
except ImportError as error:
    missing(f"{error}; ./test installs python3-pandas and python3-openpyxl")

WALL = "/models/wall"
UNITS = """code,depth,count,period,state,found,wet,note
SU 1,0.5,3,1560~,loose,2024-05-02,true,"first, with a comma"
SU 2,1.25,,156X,firm,2024-02-29,false,"two
lines"
SU 3,,7,,loose,,true,=1+1
"""
TERMS = "code,parent,label,label-es,color\nloss,,Loss,Pérdida,#c04020\nflaking,loss,Flaking,Descamación,\n"


class Reader:
    """Reads tables as a user's script does, and records the operations."""

    def __init__(self, server):
        self.server, self.read = server, set()

    def _url(self, path, query):
        return f"{self.server.url}/api/v1{path}" + (
            "?" + urllib.parse.urlencode(query) if query else ""
        )

    def _options(self):
        return {"Authorization": "Bearer " + self.server.token}

    def csv(self, operation, path, sep=",", decimal=".", **query):
        self.read.add(operation)
        return whole(
            pandas.read_csv(
                self._url(path, query), sep=sep, decimal=decimal, storage_options=self._options()
            )
        )

    def excel(self, operation, path, **query):
        self.read.add(operation)
        return whole(pandas.read_excel(self._url(path, query), storage_options=self._options()))

    def posted(self, operation, path, body):
        self.read.add(operation)
        answer = self.server.ok("POST", path, body, headers={"Accept": "text/csv"})
        return whole(pandas.read_csv(io.BytesIO(answer.body)))


def whole(frame):
    """Checks that the table has no index column, no unnamed or doubled columns, and no byte order
    mark before the first name."""
    names = [str(name) for name in frame.columns]
    assert not [
        name
        for name in names
        if name.startswith("Unnamed") or name != name.strip("\ufeff ") or name.endswith(".1")
    ], names
    # no row has more cells than the header
    assert isinstance(frame.index, pandas.RangeIndex), frame.index
    return frame


def kinds(frame):
    """Returns a letter for the type of each column: integer, float, bool, or O for texts."""
    return {name: frame[name].dtype.kind for name in frame.columns}


def same(one, other, tolerance=1e-12):
    pandas.testing.assert_frame_equal(one, other, rtol=tolerance, check_dtype=False)


def set_up(server):
    server.import_model(folded_grid(fold=0.001), "wall.ply", name="Wall", unit="mm")
    text = {"Content-Type": "text/csv"}
    server.ok("POST", "/projects/default/terms?name=Damage", TERMS.encode(), headers=text)
    server.ok(
        "POST",
        "/projects/default/tables",
        {
            "name": "Units",
            "columns": [
                {"name": "Code", "required": True, "unique": True},
                {"name": "Depth", "kind": "numeric", "unit": "m"},
                {"name": "Count", "kind": "integer"},
                {"name": "Period", "kind": "period"},
                {"name": "State", "kind": "enumeration", "choices": ["loose", "firm"]},
                {"name": "Found", "kind": "date"},
                {"name": "Wet", "kind": "boolean"},
                {"name": "Note"},
                {"name": "Empty"},
            ],
        },
    )
    report = server.ok("POST", "/tables/units/records", UNITS.encode(), headers=text).json()
    assert report["created"] == 3, report
    server.ok(
        "POST",
        WALL + "/layers",
        {"name": "Units", "kind": "database", "type": "u16", "table": "units", "resolution": 2048},
    )
    server.ok(
        "POST",
        WALL + "/layers",
        {"name": "Moisture", "type": "f32", "unit": "%", "resolution": 2048},
    )
    for layer, value, where in (
        ("units", 1, "x < 10 and y < 10"),
        ("units", 2, "x > 90 and y < 5"),
        ("moisture", 12.5, "x < 20 and y < 20"),
        ("moisture", 0.25, "x < 5 and y < 5"),
    ):
        server.ok(
            "POST",
            f"{WALL}/layers/{layer}/edits",
            {"op": "fill", "mode": "where", "where": where, "value": value},
        )


@pytest.fixture(scope="module")
def reader(server):
    set_up(server)
    return Reader(server)


def test_records(server, reader):
    frame = reader.csv("list_records", "/tables/units/records", f="csv")
    assert list(frame.columns) == [
        "key",
        "code",
        "depth",
        "count",
        "period",
        "state",
        "found",
        "wet",
        "note",
        "empty",
    ], list(frame.columns)
    assert len(frame) == server.ok("GET", "/tables/units/records").json()["total"] == 3
    assert kinds(frame) == {
        "key": "i",
        "code": "O",
        "depth": "f",
        "count": "f",
        "period": "O",
        "state": "O",
        "found": "O",
        "wet": "b",
        "note": "O",
        "empty": "f",
    }, kinds(frame)
    assert (
        frame["note"].tolist()[:2] == ["first, with a comma", "two\nlines"]
        and frame["note"][2] == "'=1+1"
    ), frame["note"].tolist()
    assert frame["depth"].sum() == 1.75 and frame["empty"].isna().all()
    found = pandas.to_datetime(frame["found"])
    assert (
        found.dtype.kind == "M"
        and found.max() == pandas.Timestamp(2024, 5, 2)
        and found.isna().sum() == 1
    )
    same(
        frame,
        reader.csv("list_records", "/tables/units/records", f="csv", separator="tab", sep="\t"),
    )
    same(
        frame,
        reader.csv(
            "list_records",
            "/tables/units/records",
            f="csv",
            separator="semicolon",
            sep=";",
            decimal=",",
        ),
    )
    assert reader.csv("list_records", "/tables/units/records", f="csv", filter="depth > 1")[
        "code"
    ].tolist() == ["SU 2"]
    book = reader.excel("list_records", "/tables/units/records", f="xlsx")
    assert list(book.columns) == list(frame.columns) and len(book) == 3
    assert (
        book["found"].dtype.kind == "M"
        and book["wet"].dtype.kind == "b"
        and book["depth"].equals(frame["depth"])
    ), kinds(book)
    layer = reader.csv("list_layer_records", WALL + "/layers/units/records", f="csv")
    assert set(layer.columns) == {*frame.columns, "area_m2"}, list(layer.columns)
    assert (
        layer["area_m2"].dtype.kind == "f" and abs(layer["area_m2"].sum() - 150e-6) < 2e-6
    ), layer["area_m2"]
    same(
        layer,
        reader.excel("list_layer_records", WALL + "/layers/units/records", f="xlsx")[
            list(layer.columns)
        ].assign(found=layer["found"], note=layer["note"]),
    )


def test_quantities(server, reader):
    for operation, path in (
        ("layer_quantities", WALL + "/layers/units/quantities"),
        ("table_quantities", "/tables/units/quantities"),
    ):
        told = server.ok("GET", path).json()
        frame = reader.csv(operation, path, f="csv")
        classes, total = frame.iloc[:-1], frame.iloc[-1]
        assert (
            classes["class"].tolist()
            == [each["class"] for each in told["quantities"]]
            == ["SU 1", "SU 2"]
        ), frame
        assert (
            total["class"] == "total"
            and abs(total["area_m2"] - classes["area_m2"].sum()) < 1e-15
            and total["texels"] == classes["texels"].sum()
        )
        assert {kinds(frame)[name] for name in ("pieces", "texels")} == {"i"} and kinds(frame)[
            "area_m2"
        ] == "f", kinds(frame)
        assert classes["key"].tolist() == [1, 2], frame
        same(frame, reader.excel(operation, path, f="xlsx"))
        same(
            frame, reader.csv(operation, path, f="csv", separator="semicolon", sep=";", decimal=",")
        )
    ranges = reader.csv("layer_quantities", WALL + "/layers/moisture/quantities", f="csv")
    assert len(ranges) == server.ok("GET", WALL + "/layers/moisture/quantities").json()["total"] + 1


def test_texels(server, reader):
    statistics = server.ok("GET", WALL + "/layers/moisture/statistics").json()
    frame = reader.csv("get_texel_lines", WALL + "/layers/moisture/texels.csv")
    assert list(frame.columns) == ["x", "y", "z", "area_m2", "value"] and set(
        kinds(frame).values()
    ) == {"f"}, kinds(frame)
    assert len(frame) == statistics["texels"] and sorted(frame["value"].unique()) == [0.25, 12.5]
    assert abs(frame["area_m2"].sum() / statistics["area_m2"] - 1) < 1e-6
    assert (
        abs(
            (frame["value"] * frame["area_m2"]).sum() / frame["area_m2"].sum() / statistics["mean"]
            - 1
        )
        < 1e-6
    )
    cells = reader.csv("get_texel_lines", WALL + "/layers/moisture/texels.csv", cell="5mm")
    # Computes the same values from the texels. The wall and some cells cross z = 0, but no cell may
    # be omitted or counted twice.
    columns = [
        each.groupby([each["x"] // 5, each["y"] // 5])["area_m2"].sum() for each in (frame, cells)
    ]
    assert len(columns[0]) == 16
    pandas.testing.assert_series_equal(*columns, rtol=1e-6)
    same(
        cells,
        reader.csv(
            "get_texel_lines",
            WALL + "/layers/moisture/texels.csv",
            cell="5mm",
            separator="semicolon",
            sep=";",
            decimal=",",
        ),
    )
    units = reader.csv(
        "get_texel_lines", WALL + "/layers/units/texels.csv", columns="code,depth", where="x > 50"
    )
    assert (
        list(units.columns) == ["x", "y", "z", "area_m2", "value", "code", "depth"]
        and kinds(units)["value"] == "i"
    ), kinds(units)
    assert set(units["code"]) == {"SU 2"} and set(units["depth"]) == {1.25}


def test_points(server, reader):
    point = reader.csv("position", WALL + "/position", coords="POINT Z(2 2 0)", f="csv")
    assert (
        len(point) == 1
        and point["moisture"][0] == 0.25
        and point["units"][0] == 1
        and point["hit"].dtype.kind == "b"
    ), point
    many = reader.posted(
        "positions",
        WALL + "/positions",
        {"points": [[2, 2, 0], [15, 15, 0], [60, 60, 0]], "layers": ["moisture"]},
    )
    assert (
        len(many) == 3
        and many["moisture"].tolist()[:2] == [0.25, 12.5]
        and pandas.isna(many["moisture"][2])
    ), many
    line = reader.posted(
        "profile",
        WALL + "/profile",
        {"places": [[1, 1, 0], [41, 1, 0]], "step_mm": 1, "layers": ["moisture"]},
    )
    assert (
        len(line) == 41
        and line["along_mm"].is_monotonic_increasing
        and set(line["moisture"].dropna()) == {0.25, 12.5}
    ), line
    table = reader.posted(
        "cross_table", WALL + "/cross-table", {"rows": "units", "columns": "units"}
    )
    assert (
        table.shape[0] == 2 and abs(table.iloc[:, 1:].to_numpy(dtype=float).sum() - 150e-6) < 2e-6
    ), table


def test_terms(server, reader):
    frame = reader.csv("list_terms", "/tables/damage/terms", f="csv")
    assert (
        len(frame) == 2
        and frame["label-es"].tolist() == ["Pérdida", "Descamación"]
        and frame["parent"].tolist()[1] == "loss"
    ), frame


def test_surveys(server, reader):
    for name, date in (("Then", "2019"), ("Now", "2025-05-01")):
        model = server.import_model(
            folded_grid(fold=0.001),
            "sheet.ply",
            name=name,
            unit="mm",
            resolution=2048,
            object="Sheet",
            survey_date=date,
        )
        layers = f"/models/{model['slug']}/layers"
        for layer, kind in (("Cracks", "u8"), ("Wetness", "f32")):
            server.ok("POST", layers, {"name": layer, "type": kind, "resolution": 2048})
        server.ok(
            "POST",
            f"{layers}/cracks/edits",
            {"op": "fill", "mode": "where", "where": "x < 40", "value": 3},
        )
    (sheet,) = [
        each
        for each in server.get("/projects/default/objects").json()["objects"]
        if each["name"] == "Sheet"
    ]
    path = f"/projects/default/objects/{sheet['id']}/statistics"
    frame = reader.csv("object_statistics", path, layer="Cracks", f="csv")
    assert frame["model"].tolist() == ["then", "now"], frame
    areas = [name for name in frame.columns if name.endswith("area_m2")]
    assert areas and all((frame[name] > 0).all() for name in areas), frame
    same(frame, reader.excel("object_statistics", path, layer="Cracks", f="xlsx"))
    empty = reader.csv("object_statistics", path, layer="Wetness", f="csv")
    assert empty["texels"].tolist() == [0, 0] and empty["mean"].isna().all(), empty

    changes = "/models/now/layers/cracks/changes?f=csv&separator=comma"
    started = server.ok("POST", changes, {"since": "then", "tolerance_mm": 1}, expect=(202,))
    job = server.wait_for_job(started.json()["id"])
    table = reader.csv("get_job_file", f"/jobs/{job['id']}/file")
    assert table.iloc[:, 0].tolist() == ["3", "not painted", "no counterpart", "total"], table
    assert table["3"].tolist()[0] > 0 and set(list(kinds(table).values())[1:]) <= {"f", "i"}, table


def test_every_csv_of_the_contract_was_read(server, reader):
    csv = {
        operation["operationId"]
        for methods in server.contract.document["paths"].values()
        for method, operation in methods.items()
        if method in ("get", "post")
        and "text/csv" in operation["responses"].get("200", {}).get("content", {})
    }
    assert (
        reader.read == csv
    ), f"not read: {csv - reader.read}; not in the contract: {reader.read - csv}"


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
