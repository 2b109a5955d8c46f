// The values that a column of a table accepts: values of each kind, in JSON and as text. The file
// also tests columns with contradictory settings.
#include <gtest/gtest.h>

#include "domain/tables/column_value.h"

namespace strata {
namespace {

using nlohmann::json;

Column column(ColumnKind kind) {
  Column made;
  made.id = 3;
  made.name = "Column";
  made.slug = "column";
  made.kind = kind;
  if (kind == ColumnKind::enumeration) made.choices = {"good", "fair", "=bad"};
  if (kind == ColumnKind::term || kind == ColumnKind::relation) made.target = TableId(7);
  return made;
}

json stored(const Column& of, const json& value) {
  const auto checked = check_value(of, value, "values/column");
  EXPECT_TRUE(checked.has_value()) << value << ": " << (checked ? "" : checked.error().detail);
  return checked.value_or(json("refused"));
}

void expect_refused(const Column& of, const json& value) {
  const auto checked = check_value(of, value, "values/column");
  ASSERT_FALSE(checked.has_value()) << value;
  EXPECT_EQ(checked.error().code, ErrorCode::invalid);
  EXPECT_EQ(checked.error().field, "values/column");
  EXPECT_FALSE(checked.error().detail.empty());
}

TEST(ColumnValue, names_of_kinds_are_read_back) {
  for (int i = 0; i <= static_cast<int>(ColumnKind::document); ++i) {
    const auto kind = static_cast<ColumnKind>(i);
    EXPECT_EQ(parse_column_kind(name(kind)), kind);
  }
  EXPECT_FALSE(parse_column_kind("drawing").has_value());
}

TEST(ColumnValue, texts_are_utf8_and_blank_ones_are_none) {
  EXPECT_EQ(stored(column(ColumnKind::text), "Größe ☃"), "Größe ☃");
  EXPECT_EQ(stored(column(ColumnKind::text), " \n"), json());
  expect_refused(column(ColumnKind::text), 3);
  expect_refused(column(ColumnKind::text), "\xff");
  expect_refused(column(ColumnKind::text), std::string("a\0b", 3));
  expect_refused(column(ColumnKind::text), std::string(kMaxTextLength + 1, 'a'));
}

TEST(ColumnValue, numbers_keep_to_the_limits_of_their_column) {
  Column whole = column(ColumnKind::integer);
  whole.minimum = 0;
  whole.maximum = 10;
  EXPECT_EQ(stored(whole, 10), 10);
  EXPECT_EQ(stored(whole, 3.0).dump(), "3");
  for (const json& bad : {json(-1), json(11), json(2.5), json("3"), json(true), json::array({1})})
    expect_refused(whole, bad);
  expect_refused(column(ColumnKind::integer), 1e300);
  expect_refused(column(ColumnKind::integer), UINT64_MAX);
  EXPECT_EQ(stored(column(ColumnKind::integer), kGreatestInteger), kGreatestInteger);
  EXPECT_EQ(stored(column(ColumnKind::numeric), 0.1).dump(), "0.1");
  EXPECT_EQ(stored(column(ColumnKind::numeric), -0.0).dump(), "0.0");
  expect_refused(column(ColumnKind::numeric), std::numeric_limits<double>::infinity());
  expect_refused(column(ColumnKind::numeric), std::numeric_limits<double>::quiet_NaN());
}

TEST(ColumnValue, dates_and_times_are_of_the_calendar) {
  const Column date = column(ColumnKind::date), time = column(ColumnKind::timestamp);
  EXPECT_EQ(stored(date, "2024-02-29"), "2024-02-29");
  for (const char* bad :
       {"2023-02-29", "2024-2-9", "0000-01-01", "2024-13-01", "2024-02-29T00:00:00Z", "29.2.2024"})
    expect_refused(date, bad);
  EXPECT_EQ(stored(time, "2024-02-29T12:30:00Z"), "2024-02-29T12:30:00.000Z");
  EXPECT_EQ(stored(time, "2024-02-29 23:30:15.1239-01:30"), "2024-03-01T01:00:15.123Z");
  EXPECT_EQ(stored(time, "2024-03-01T00:30+01:00"), "2024-02-29T23:30:00.000Z");
  EXPECT_EQ(stored(time, "1066-10-14"), "1066-10-14T00:00:00.000Z");
  EXPECT_EQ(stored(time, "9999-12-31T23:59:59.999Z"), "9999-12-31T23:59:59.999Z");
  for (const char* bad :
       {"2024-02-29T24:00:00Z", "2024-02-29T12:60Z", "2024-02-29T12", "2024-02-29T12:00:00.Z",
        "0001-01-01T00:00:00+01:00", "9999-12-31T23:59:59-00:01", "2024-02-29T12:00:00 UTC", "now"})
    expect_refused(time, bad);
}

TEST(ColumnValue, the_other_kinds_take_what_they_are_made_for) {
  EXPECT_EQ(stored(column(ColumnKind::boolean), true), true);
  expect_refused(column(ColumnKind::boolean), 1);
  EXPECT_EQ(stored(column(ColumnKind::period), "1560~/.."), "1560~/..");
  expect_refused(column(ColumnKind::period), "circa 1560");
  EXPECT_EQ(stored(column(ColumnKind::enumeration), "fair"), "fair");
  expect_refused(column(ColumnKind::enumeration), "Fair");
  EXPECT_EQ(stored(column(ColumnKind::url), "https://example.org/a?b=c#d"),
            "https://example.org/a?b=c#d");
  for (const char* bad :
       {"javascript:alert(1)", "data:text/html,x", "https://", "http://a b", "example.org", "urn:"})
    expect_refused(column(ColumnKind::url), bad);
  EXPECT_EQ(stored(column(ColumnKind::term), 4294967295), 4294967295);
  for (const json& bad : {json(-1), json(4294967296), json(1.5), json("1")})
    expect_refused(column(ColumnKind::term), bad);
  EXPECT_EQ(stored(column(ColumnKind::relation), {5, 1, 5}), json({1, 5}));
  EXPECT_EQ(stored(column(ColumnKind::relation), json::array()), json());
  expect_refused(column(ColumnKind::relation), 5);
  expect_refused(column(ColumnKind::relation), {"5"});
}

TEST(ColumnValue, only_a_required_column_refuses_to_be_empty) {
  for (int i = 0; i <= static_cast<int>(ColumnKind::relation); ++i) {
    Column any = column(static_cast<ColumnKind>(i));
    EXPECT_EQ(stored(any, json()), json());
    any.required = true;
    expect_refused(any, json());
    EXPECT_FALSE(parse_value(any, " ", false, "cell").has_value());
  }
  Column text = column(ColumnKind::text);
  text.required = true;
  expect_refused(text, "  ");
}

TEST(ColumnValue, texts_of_values_are_read_back) {
  const std::pair<ColumnKind, json> values[] = {{ColumnKind::text, "=1+1"},
                                                {ColumnKind::text, "'=x"},
                                                {ColumnKind::text, " two\nlines "},
                                                {ColumnKind::integer, -42},
                                                {ColumnKind::numeric, 0.1},
                                                {ColumnKind::numeric, -1e-300},
                                                {ColumnKind::boolean, false},
                                                {ColumnKind::date, "2024-02-29"},
                                                {ColumnKind::timestamp, "2024-02-29T00:00:00.001Z"},
                                                {ColumnKind::period, "-0043/0100"},
                                                {ColumnKind::enumeration, "=bad"},
                                                {ColumnKind::url, "https://example.org/"},
                                                {ColumnKind::term, 4294967295},
                                                {ColumnKind::relation, {1, 2, 99}},
                                                {ColumnKind::text, json()}};
  for (const auto& [kind, value] : values) {
    const auto again = parse_value(column(kind), print_value(column(kind), value), false, "cell");
    ASSERT_TRUE(again.has_value()) << value;
    EXPECT_EQ(*again, value);
  }
  EXPECT_EQ(print_value(column(ColumnKind::text), "=1+1"), "'=1+1");
}

TEST(ColumnValue, cells_are_read_as_people_write_them) {
  EXPECT_EQ(parse_value(column(ColumnKind::numeric), " 3,5 ", true, "cell").value(), 3.5);
  EXPECT_FALSE(parse_value(column(ColumnKind::numeric), "3,5", false, "cell").has_value());
  EXPECT_FALSE(parse_value(column(ColumnKind::numeric), "1,234,567", true, "cell").has_value());
  EXPECT_EQ(parse_value(column(ColumnKind::integer), "+7", false, "cell").value(), 7);
  EXPECT_EQ(parse_value(column(ColumnKind::boolean), "Yes", false, "cell").value(), true);
  EXPECT_FALSE(parse_value(column(ColumnKind::boolean), "maybe", false, "cell").has_value());
  EXPECT_EQ(parse_value(column(ColumnKind::relation), "3; 1 2", false, "cell").value(),
            json({1, 2, 3}));
  EXPECT_FALSE(parse_value(column(ColumnKind::relation), "3; x", false, "cell").has_value());
}

TEST(ColumnValue, retyping_keeps_what_the_new_kind_can_hold) {
  const auto converted = [](ColumnKind from, ColumnKind to, const json& value) {
    return convert_value(column(from), column(to), value, "cell").value_or(json("refused"));
  };
  EXPECT_EQ(converted(ColumnKind::integer, ColumnKind::text, 12), "12");
  EXPECT_EQ(converted(ColumnKind::text, ColumnKind::integer, "12"), 12);
  EXPECT_EQ(converted(ColumnKind::text, ColumnKind::integer, "twelve"), "refused");
  EXPECT_EQ(converted(ColumnKind::numeric, ColumnKind::integer, 2.0), 2);
  EXPECT_EQ(converted(ColumnKind::numeric, ColumnKind::integer, 2.5), "refused");
  EXPECT_EQ(converted(ColumnKind::timestamp, ColumnKind::date, "2024-02-29T12:00:00.000Z"),
            "2024-02-29");
  EXPECT_EQ(converted(ColumnKind::date, ColumnKind::timestamp, "2024-02-29"),
            "2024-02-29T00:00:00.000Z");
  EXPECT_EQ(converted(ColumnKind::date, ColumnKind::period, "2024-02-29"), "2024-02-29");
  EXPECT_EQ(converted(ColumnKind::term, ColumnKind::relation, 5), json({5}));
  EXPECT_EQ(converted(ColumnKind::text, ColumnKind::text, "'=x"), "'=x");
  EXPECT_EQ(converted(ColumnKind::text, ColumnKind::date, json()), json());
  Column elsewhere = column(ColumnKind::term);
  elsewhere.target = TableId(8);
  EXPECT_FALSE(convert_value(column(ColumnKind::term), elsewhere, 5, "cell").has_value());
}

TEST(ColumnValue, a_column_that_does_not_fit_together_is_refused_by_its_field) {
  const auto field_of = [](Column made) {
    const auto checked = check_column(made);
    return checked ? std::string() : checked.error().field;
  };
  for (int i = 0; i <= static_cast<int>(ColumnKind::relation); ++i)
    EXPECT_EQ(field_of(column(static_cast<ColumnKind>(i))), "") << i;
  const auto changed = [&](ColumnKind kind, auto change) {
    Column made = column(kind);
    change(made);
    return field_of(made);
  };
  EXPECT_EQ(changed(ColumnKind::text, [](Column& c) { c.name = ""; }), "name");
  EXPECT_EQ(changed(ColumnKind::text, [](Column& c) { c.unit = "mm"; }), "unit");
  EXPECT_EQ(changed(ColumnKind::text, [](Column& c) { c.minimum = 1; }), "minimum");
  EXPECT_EQ(changed(ColumnKind::text, [](Column& c) { c.maximum = 1; }), "maximum");
  EXPECT_EQ(changed(ColumnKind::numeric, [](Column& c) { c.minimum = 2, c.maximum = 1; }),
            "minimum");
  EXPECT_EQ(changed(ColumnKind::text, [](Column& c) { c.choices = {"a"}; }), "choices");
  EXPECT_EQ(changed(ColumnKind::enumeration, [](Column& c) { c.choices = {}; }), "choices");
  EXPECT_EQ(changed(ColumnKind::enumeration, [](Column& c) { c.choices = {"a", "a"}; }), "choices");
  EXPECT_EQ(changed(ColumnKind::term, [](Column& c) { c.target.reset(); }), "target");
  EXPECT_EQ(changed(ColumnKind::date, [](Column& c) { c.target = TableId(1); }), "target");
  EXPECT_EQ(changed(ColumnKind::relation, [](Column& c) { c.unique = true; }), "unique");
  EXPECT_EQ(changed(ColumnKind::boolean, [](Column& c) { c.unique = true; }), "unique");
  EXPECT_EQ(changed(ColumnKind::text, [](Column& c) { c.unique = true, c.default_value = "a"; }),
            "default");
  EXPECT_EQ(changed(ColumnKind::integer, [](Column& c) { c.default_value = "a"; }), "default");
  EXPECT_EQ(changed(ColumnKind::text,
                    [](Column& c) {
                      c.labels = {{"es", "Nombre"}, {"pt-BR", "Nome"}};
                    }),
            "");
  EXPECT_EQ(changed(ColumnKind::text,
                    [](Column& c) {
                      c.labels = {{"not a tag", "x"}};
                    }),
            "labels");
}

TEST(ColumnValue, a_record_tells_every_column) {
  Column first = column(ColumnKind::text), second = column(ColumnKind::integer);
  second.id = 4;
  second.slug = "second";
  const Record record{12, 3, {{ColumnId(4), 7}}};
  EXPECT_EQ(to_json(record, {first, second}),
            json({{"key", 12}, {"version", 3}, {"values", {{"column", nullptr}, {"second", 7}}}}));
  EXPECT_EQ(find_column({first, second}, "4")->slug, "second");
  EXPECT_EQ(find_column({first, second}, "column")->id, ColumnId(3));
  EXPECT_EQ(find_column({first, second}, "none"), nullptr);
}

}  // namespace
}  // namespace strata
