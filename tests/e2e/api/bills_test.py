"""Bills of quantities over HTTP: rules over records, classes and depths, hand measurements, rounding,
roles, GAEB files in and out, and the workbook, recomputed here with decimal numbers."""
import io
import math
import re
import xml.etree.ElementTree as xml
from decimal import ROUND_HALF_UP, ROUND_UP, Decimal

import pytest
from support.meshes import folded_grid
from support.missing import missing
from support.readings import dab

try:
    import openpyxl
except ImportError as error:
    missing(f"{error}; ./test installs python3-openpyxl")

BILLS = "/projects/default/bills"
RADII = {1: 10, 2: 5, 3: 3}  # mm, by key
LINE_M = 0.04
DA31 = "{http://www.gaeb.de/GAEB_DA_XML/DA31/3.3}"


def rounded(value, places="0.01"):
    return Decimal(value).quantize(Decimal(places), ROUND_HALF_UP)


def disc_m2(radius_mm):
    return math.pi * radius_mm**2 / 1e6


@pytest.fixture(scope="module")
def server(server):
    server.import_model(
        folded_grid(fold=0.001), "sheet.ply", name="Sheet", unit="mm", resolution=2048
    )
    columns = [
        {"name": "Name"},
        {"name": "Kind"},
        {"name": "Depth", "kind": "numeric", "unit": "mm"},
        {"name": "Path", "kind": "line"},
    ]
    finds = {"name": "Finds", "kind": "database", "type": "u16", "columns": columns}
    server.ok("POST", "/models/sheet/layers", {**finds, "resolution": 2048})
    line = [{"model": 1, "coordinates": [[10, 10, 0], [50, 10, 0]]}]
    records = [
        {"name": "North", "kind": "loss", "depth": 20, "path": line},
        {"name": "West", "kind": "loss", "depth": 10},
        {"name": "Window", "kind": "opening"},
    ]
    server.ok("POST", "/tables/finds/records", {"records": [{"values": each} for each in records]})
    for key, radius in RADII.items():
        dab(server, "/models/sheet/layers/finds", key, 20 * key, 50, radius)
    for name, type_, value, unit in (("Soiling", "u8", 2, ""), ("Relief", "f32", 7.5, "mm")):
        body = {"name": name, "type": type_, "unit": unit, "resolution": 2048}
        if type_ == "u8":
            body["palette"] = {
                "mode": "categorical",
                "points": [{"at": 2, "color": "#d55e00", "label": "Soot"}],
            }
        server.ok("POST", "/models/sheet/layers", body)
        dab(server, "/models/sheet/layers/" + name.lower(), value, 50, 50, 40)
    return server


@pytest.fixture(scope="module")
def ids(server):
    layers = {
        each["slug"]: each["id"] for each in server.get("/models/sheet/layers").json()["layers"]
    }
    return {"table": server.get("/tables/finds").json()["id"], "layers": layers, "model": 1}


def position(number, unit, *rules, **more):
    return {"number": number, "unit": unit, "rules": list(rules), **more}


@pytest.fixture(scope="module")
def bill(server, ids):
    loss = {"table": ids["table"], "where": "kind = 'loss'"}
    exact = {"places": 6}
    items = [
        {"number": "01", "kind": "group", "short_text": "Stone"},
        position(
            "01.0010",
            "m2",
            {**loss, "measure": "area", "figure": "Fig. 3"},
            rounding=exact,
            short_text="Fill losses",
            unit_price="1250.55",
        ),
        position("01.0020", "m", {**loss, "measure": "length"}, rounding=exact, unit_price="10"),
        position(
            "01.0030", "St", {**loss, "measure": "count"}, rounding={"places": 0}, unit_price="5"
        ),
        position(
            "01.0040",
            "m3",
            {**loss, "measure": "volume", "depth": {"column": "depth"}},
            rounding={"places": 6, "each": "element"},
            unit_price="1",
        ),
        position(
            "01.0050",
            "m3",
            {**loss, "measure": "volume", "depth": {"layer": "relief"}},
            rounding=exact,
        ),
        position(
            "01.0060",
            "m2",
            {"model": 1, "layer": ids["layers"]["soiling"], "values": [2], "measure": "area"},
            {
                "table": ids["table"],
                "where": "kind = 'opening'",
                "measure": "area",
                "deduct": True,
                "overmeasured_up_to": "0.0001",
            },
            rounding={"places": 4},
        ),
        position(
            "01.0070",
            "m2",
            {**loss, "measure": "area", "size": {"over": "0.0001", "up_to": "1"}},
            rounding={"places": 2, "smallest": "0.1", "mode": "up", "each": "element"},
        ),
        position(
            "01.0080",
            "psch",
            measurements=[{"text": "Setup", "formula": "2 * 1,20 * 0,85", "remark": "site"}],
        ),
    ]
    made = server.ok("POST", BILLS, {"name": "Facade", "items": items}).json()
    return f"{BILLS}/{made['id']}"


@pytest.fixture(scope="module")
def gaeb_bill(server, bill):
    """The same bill with at most the 3 decimal places that GAEB allows."""
    items = server.get(bill).json()["items"]
    for item in items:
        rounding = item.get("rounding", {})
        if rounding.get("places", 2) > 3:
            item["rounding"] = {**rounding, "places": 3}
    made = server.ok("POST", BILLS, {"name": "Facade for GAEB", "items": items}).json()
    return f"{BILLS}/{made['id']}"


@pytest.fixture(scope="module")
def measured(server, bill):
    answer = server.ok("GET", bill + "/quantities").json()
    return {each["number"]: each for each in answer["positions"]}, answer


def near(text, expected):
    return abs(float(text) / expected - 1) < 0.05


def test_lines_name_their_element_and_their_figure(measured, ids):
    first, second = measured[0]["01.0010"]["lines"]
    assert (first["title"], first["key"], first["table"]) == ("North", 1, ids["table"])
    assert (first["model_name"], first["layer_name"]) == ("Sheet", "Finds")
    assert (first["figure"], first["link"], first["rule"]) == ("Fig. 3", "/models/sheet", 1)
    assert near(first["measured"], disc_m2(10)) and near(second["measured"], disc_m2(5))


def test_quantities_are_areas_lengths_counts_and_volumes(measured):
    positions = measured[0]
    assert near(positions["01.0010"]["quantity"], disc_m2(10) + disc_m2(5))
    assert near(positions["01.0020"]["quantity"], LINE_M)
    assert positions["01.0030"]["quantity"] == "2"
    by_column = disc_m2(10) * 0.02 + disc_m2(5) * 0.01
    assert near(positions["01.0040"]["quantity"], by_column)
    assert near(positions["01.0050"]["quantity"], (disc_m2(10) + disc_m2(5)) * 0.0075)


def test_small_openings_are_overmeasured_and_small_elements_have_a_smallest_size(measured):
    soot, opening = measured[0]["01.0060"]["lines"]
    assert (soot["title"], soot["effect"]) == ("Soot", "billed")
    assert (opening["effect"], opening["billed"]) == ("overmeasured", "0")
    (only,) = measured[0]["01.0070"]["lines"]  # the other one is smaller than its class
    assert (only["title"], only["effect"], only["billed"]) == ("North", "smallest", "0.1")


def test_sums_are_exact(measured):
    positions, answer = measured
    total = Decimal(0)
    for each in positions.values():
        places = Decimal(1).scaleb(-len(each["quantity"].partition(".")[2]))
        lines = sum(Decimal(line["billed"]) for line in each["lines"])
        assert Decimal(each["quantity"]) == lines.quantize(places, ROUND_HALF_UP), each
        if "unit_price" in each:
            of_price = rounded(Decimal(each["quantity"]) * Decimal(each["unit_price"]))
            assert each["total"] == str(of_price), each
            total += of_price
    assert answer["total"] == str(total) and total > 0


def test_hand_measurements_name_who_entered_them(server, bill, measured):
    (line,) = measured[0]["01.0080"]["lines"]
    assert (line["formula"], line["billed"], line["remark"]) == ("2 * 1,20 * 0,85", "2.04", "site")
    assert line["user"] == "owner" and line["time"].startswith("20")
    whole = server.get(bill).json()
    lines = whole["items"][-1]["measurements"]
    carl = server.add_person("carl", "curator")
    lines.append({"formula": "1", "text": "Forged", "user": "owner", "time": "1999"})
    put = {key: whole[key] for key in ("name", "currency", "items")}
    changed = server.request("PUT", bill, put, token=carl).json()
    assert [each["user"] for each in changed["items"][-1]["measurements"]] == ["owner", "carl"]
    assert changed["items"][-1]["measurements"][0] == lines[0]
    assert changed["version"] == whole["version"] + 1
    stale = server.request("PUT", bill, put, headers={"If-Match": f'"v{whole["version"]}"'})
    assert stale.status == 412, stale


def test_a_hand_measurement_replaces_a_measured_line(server, bill, measured):
    whole = server.get(bill).json()
    put = {key: whole[key] for key in ("name", "items")}
    north = measured[0]["01.0010"]["lines"][0]["id"]
    put["items"][1]["measurements"] = [{"formula": "0,5", "replaces": north}]
    server.ok("PUT", bill, put)
    first = server.get(bill + "/quantities").json()["positions"][0]
    assert [line["effect"] for line in first["lines"]] == ["replaced", "billed", "billed"]
    assert near(first["quantity"], 0.5 + disc_m2(5))
    put["items"][1]["measurements"][0]["replaces"] = "layer 1 key 99"
    server.ok("PUT", bill, put)
    refused = server.request("GET", bill + "/quantities")
    assert refused.status == 422 and refused.json()["field"] == "items[1].replaces", refused
    put["items"][1]["measurements"][0]["replaces"] = north
    server.ok("PUT", bill, put)


@pytest.mark.parametrize(
    "rule, field",
    [
        ({"table": 99, "measure": "area"}, "table"),
        ({"model": 99, "layer": 1, "measure": "area"}, "model"),
        ({"table": 1, "where": "nothing = 1", "measure": "area"}, "where"),
        ({"table": 1, "where": "kind =", "measure": "area"}, "where"),
        ({"model": 1, "layer": 1, "measure": "area"}, "table"),
    ],
)
def test_rules_without_a_source_are_refused_when_they_are_measured(server, ids, rule, field):
    rule = {**rule, **({"table": ids["table"]} if rule.get("table") == 1 else {})}
    if "layer" in rule and rule["model"] == 1:
        rule["layer"] = ids["layers"]["finds"]
    made = server.ok("POST", BILLS, {"name": "Bad", "items": [position("1", "m2", rule)]}).json()
    refused = server.request("GET", f"{BILLS}/{made['id']}/quantities")
    assert refused.status == 422, refused
    assert refused.json()["field"] == f"items[0].rules[0].{field}", refused.json()
    server.ok("DELETE", f"{BILLS}/{made['id']}")


def test_mistakes_in_a_bill_are_refused_when_it_is_stored(server):
    for item, field in (
        ({"number": "1.2"}, "items[0].number"),
        (
            {"number": "1", "unit": "m", "rules": [{"table": 1, "measure": "area"}]},
            "items[0].rules[0].measure",
        ),
        ({"number": "1", "measurements": [{"formula": "2 *"}]}, "items[0].measurements[0].formula"),
    ):
        refused = server.request("POST", BILLS, {"name": "Bad", "items": [item]})
        assert refused.status == 422 and refused.json()["field"] == field, refused.json()
    taken = server.request("POST", BILLS, {"name": "FACADE"})
    assert taken.status == 409 and taken.json()["field"] == "name", taken


def test_only_curators_see_bills(server, bill):
    for role in ("viewer", "annotator"):
        token = server.add_person("a-" + role, role)
        for method, path in (
            ("GET", BILLS),
            ("GET", bill),
            ("GET", bill + "/quantities"),
            ("GET", bill + "/file"),
            ("DELETE", bill),
        ):
            assert server.request(method, path, token=token).status == 403, (role, method, path)


def recomputed(book):
    """Computes the formulas of the workbook with decimal numbers."""
    lines = [
        {cell.column_letter: cell.value for cell in row}
        for row in book["Lines"].iter_rows(min_row=2)
    ]

    def rounding(text, value):
        found = re.fullmatch(r"(ROUND|ROUNDUP)\((.+),(\d)\)", text)
        if not found:
            return value(text)
        places = Decimal(1).scaleb(-int(found[3]))
        mode = ROUND_HALF_UP if found[1] == "ROUND" else ROUND_UP
        return value(found[2]).quantize(places, mode)

    def billed(row, cells):
        def value(text):
            product = Decimal(1)
            for factor in text.lstrip("-").split("*"):
                cell = re.fullmatch(rf"([JK]){row}", factor)
                product *= Decimal(str(cells[cell[1]] if cell else factor))
            return -product if text.startswith("-") else product

        return rounding(cells["L"].removeprefix("="), value)

    of_line = {row: billed(row, cells) for row, cells in enumerate(lines, 2)}

    def total(text):
        if text == "0":
            return Decimal(0)
        first, last = map(int, re.fullmatch(r"SUM\(Lines!L(\d+):L(\d+)\)", text).groups())
        return sum(of_line[row] for row in range(first, last + 1))

    return {
        row[0].value: rounding(row[4].value.removeprefix("="), total)
        for row in book["Bill"].iter_rows(min_row=2)
        if row[4].value
    }


def test_the_workbook_has_formulas_that_give_the_quantities(server, bill):
    answer = server.ok("GET", bill + "/quantities").json()
    file = server.ok("GET", bill + "/file?f=xlsx")
    assert "facade.xlsx" in file.headers["Content-Disposition"]
    book = openpyxl.load_workbook(io.BytesIO(file.body))
    assert book.sheetnames == ["Bill", "Lines"]
    quantities = recomputed(book)
    assert quantities == {each["number"]: Decimal(each["quantity"]) for each in answer["positions"]}
    values = openpyxl.load_workbook(io.BytesIO(file.body), data_only=True)
    stored = {
        row[0].value: row[4].value
        for row in values["Bill"].iter_rows(min_row=2)
        if row[4].value is not None
    }
    assert all(abs(stored[number] - float(value)) < 1e-9 for number, value in quantities.items())
    last = list(values["Bill"].iter_rows())[-1]
    assert last[1].value == "Total (EUR)" and rounded(str(last[7].value)) == Decimal(
        answer["total"]
    )
    titles = [row[2].value for row in values["Lines"].iter_rows(min_row=2)]
    assert "North" in titles and "Soot" in titles


def test_gaeb_refuses_more_decimal_places_than_it_has(server, bill):
    for phase in ("x31", "x83"):
        refused = server.request("GET", f"{bill}/file?f={phase}")
        assert refused.status == 422 and "3 decimal places" in refused.json()["detail"], refused


def test_x31_contains_the_proof_of_the_quantities(server, gaeb_bill):
    answer = server.ok("GET", gaeb_bill + "/quantities").json()
    file = server.ok("GET", gaeb_bill + "/file?f=x31")
    root = xml.fromstring(file.body)
    items = {each.get("RNoPart"): each for each in root.iter(DA31 + "Item")}
    assert root.find(f"{DA31}QtyDeterm/{DA31}DP").text == "31"
    for each in answer["positions"]:
        proof = items[each["number"].split(".")[1]].find(DA31 + "QtyDeterm")
        assert Decimal(proof.find(DA31 + "Qty").text) == Decimal(each["quantity"])
        rows = [row.get("Row") for row in proof.iter(DA31 + "QTakeoff")]
        assert all(len(row) == 80 for row in rows), rows
        terms = [row[33:68].strip() for row in rows if row[29:31] == "91"]
        plain = [term for term in terms if re.fullmatch(r"-?[\d,]+=", term)]
        assert len(terms) == len(each["lines"])
        if len(plain) == len(terms):
            total = sum(Decimal(term[:-1].replace(",", ".")) for term in plain)
            assert total == sum(Decimal(line["billed"]) for line in each["lines"])
    assert any(
        "North, Sheet, Finds, Fig. 3" in row
        for row in (each.get("Row") for each in root.iter(DA31 + "QTakeoff"))
    )


def test_a_tender_is_exported_and_imported(server, bill, gaeb_bill):
    file = server.ok("GET", gaeb_bill + "/file?f=x83")
    made = server.ok(
        "POST", BILLS + "/gaeb?name=Back", file.body, headers={"Content-Type": "application/xml"}
    )
    back = made.json()
    assert made.headers["Location"] == f"/api/v1{BILLS}/{back['bill']['id']}"
    assert (back["phase"], back["bill"]["name"], back["remarks"]) == ("x83", "Back", [])
    before = server.get(bill).json()["items"]
    assert [(each["number"], each.get("unit", "")) for each in back["bill"]["items"]] == [
        (each["number"], each.get("unit", "")) for each in before
    ]
    listed = server.get(BILLS).json()
    assert listed["total"] == 3 and [each["positions"] for each in listed["bills"]] == [8] * 3
    refused = server.request("GET", gaeb_bill + "/file?f=x84")
    assert refused.status == 422 and refused.json()["field"] == "f", refused
    assert server.request("GET", bill + "/file?f=d83").status in (400, 406)


def test_old_and_damaged_files_are_refused_with_what_to_do(server):
    for content, word in (
        (b"#begin[GAEB]\r\n#end[GAEB]", "GAEB DA XML"),
        (b"00        83L      1122PPPPI\r\n", "GAEB 90"),
        (b"<GAEB><Award>", "Export it again"),
    ):
        refused = server.request(
            "POST", BILLS + "/gaeb", content, headers={"Content-Type": "application/octet-stream"}
        )
        assert refused.status in (400, 415, 422), refused
        assert word in refused.json()["detail"] and refused.json()["field"] == "body", refused
