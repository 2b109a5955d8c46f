"""The installed templates are complete in three languages. Their terms differ by code, and by color
or pattern. Tables in which users draw have columns for lines and points.
"""
import pytest

LANGUAGES = ("de", "es")
# CIE76 in Lab. Two colors at a distance of 12 are clearly different side by side. People cannot see
# a distance below 2.
LEAST_DIFFERENCE = 12


@pytest.fixture(scope="module")
def templates(server):
    return server.ok("GET", "/templates").json()["templates"]


def lab(color):
    linear = [
        part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4
        for part in (int(color[at : at + 2], 16) / 255 for at in (1, 3, 5))
    ]
    rows = (
        (0.4124, 0.3576, 0.1805, 0.9505),
        (0.2126, 0.7152, 0.0722, 1.0),
        (0.0193, 0.1192, 0.9505, 1.089),
    )
    x, y, z = (
        (lambda t: t ** (1 / 3) if t > 0.008856 else 7.787 * t + 16 / 116)(
            sum(part * factor for part, factor in zip(linear, row)) / row[3]
        )
        for row in rows
    )
    return 116 * y - 16, 500 * (x - y), 200 * (y - z)


def difference(one, other):
    return sum((a - b) ** 2 for a, b in zip(lab(one), lab(other))) ** 0.5


def lists_of(templates):
    return [
        (f"{template['slug']}: {table['slug']}", table["terms"])
        for template in templates
        for table in template["tables"]
        if table.get("terms")
    ]


def test_everything_that_has_a_name_has_it_in_three_languages(templates):
    for template in templates:
        parts = [template, *template["tables"], *template["layers"]]
        parts += [template["group"]] if "group" in template else []
        for table in template["tables"]:
            parts += table.get("columns") or []
        named = [(part["name"], part) for part in parts]
        for table in template["tables"]:
            named += [(term["label"], term) for term in table.get("terms") or []]
        for name, part in named:
            for language in LANGUAGES:
                assert part.get("labels", {}).get(language, "").strip(), f"{name}: {language}"


def test_the_names_of_a_list_are_unique_in_each_language(templates):
    for where, terms in lists_of(templates):
        for what, names in [
            ("code", [term["code"] for term in terms]),
            ("en", [term["label"] for term in terms]),
            *[(each, [term["labels"][each] for term in terms]) for each in LANGUAGES],
        ]:
            twice = {name for name in names if names.count(name) > 1}
            assert not twice, f"{where}: {what}: {twice}"


def test_every_term_has_a_definition_a_color_and_a_pattern(templates):
    for where, terms in lists_of(templates):
        for term in terms:
            assert term["definition"].endswith("."), f"{where}: {term['code']}"
            assert term["color"] and term["pattern"], f"{where}: {term['code']}"


def test_terms_with_the_same_pattern_have_different_colors(templates):
    for where, terms in lists_of(templates):
        for at, term in enumerate(terms):
            for other in terms[:at]:
                if term["pattern"] == other["pattern"]:
                    apart = difference(term["color"], other["color"])
                    assert (
                        apart >= LEAST_DIFFERENCE
                    ), f"{where}: {term['code']} and {other['code']} differ by {apart:.1f}"


def test_the_stone_terms_are_in_the_five_families_of_the_glossary(templates):
    terms = dict(lists_of(templates))["stone-condition: stone-condition-terms"]
    assert [term["code"] for term in terms if not term.get("parent")] == [
        "crack-deformation",
        "detachment",
        "material-loss",
        "discoloration-deposit",
        "biological-colonization",
    ]
    named = {term["label"]: term["labels"] for term in terms}
    assert named["Alveolization"] == {"de": "Alveolarverwitterung", "es": "Alveolización"}
    assert named["Pitting"]["de"] == "Lochbildung"


def test_every_layer_of_a_template_can_take_lines_and_points(templates):
    for template in templates:
        tables = {table["slug"]: table for table in template["tables"]}
        for layer in template["layers"]:
            kinds = {column["kind"] for column in tables[layer["table"]]["columns"]}
            assert {"line", "point"} <= kinds, f"{template['slug']}: {layer['name']}"


def test_records_are_called_by_their_term_or_code(templates):
    """The name of a record is a unique or required text, or else the term in the first column."""
    for template in templates:
        for table in template["tables"]:
            if table.get("terms"):
                continue
            first, *others = table["columns"]
            named = [each["name"] for each in others if each.get("unique") or each.get("required")]
            code = first["kind"] == "text" and first["unique"] and first["required"]
            assert not named and (first["kind"] == "term" or code), f"{table['slug']}: {named}"


def test_the_server_ends_with_a_clean_log(server):
    assert server.stop() == 0
    server.assert_clean_log()
