// Lines and points of records: the content of cells, and its text.
#include "domain/tables/surface_feature.h"

#include <gtest/gtest.h>

#include <random>

#include "domain/tables/column_value.h"

namespace strata {
namespace {

using nlohmann::json;

Column column_of(ColumnKind kind) {
  Column column;
  column.name = "Crack";
  column.kind = kind;
  return column;
}

TEST(SurfaceFeature, what_is_written_is_read_again_as_json_and_as_text) {
  std::mt19937_64 random(5);
  const auto number = [&] {
    return std::ldexp(static_cast<double>(static_cast<std::int64_t>(random())),
                      static_cast<int>(random() % 56) - 80);
  };
  for (int round = 0; round < 200; ++round) {
    const bool lines = round % 2 == 0;
    std::vector<SurfaceFeature> features(1 + random() % 4);
    for (SurfaceFeature& feature : features) {
      feature.model = ModelId(1 + static_cast<std::int64_t>(random() % 1000));
      feature.places.resize(lines ? 2 + random() % 5 : 1);
      for (auto& place : feature.places) place = {number(), number(), number()};
    }
    const json value = to_json(features);
    EXPECT_EQ(read_features(value, lines), features);
    EXPECT_EQ(read_features(json::parse(value.dump()), lines), features);
    EXPECT_EQ(parse_features(print_features(features, lines), lines), features)
        << print_features(features, lines);
    EXPECT_EQ(read_features(value, !lines), std::nullopt);
    const Column column = column_of(lines ? ColumnKind::line : ColumnKind::point);
    EXPECT_EQ(parse_value(column, print_value(column, value), false, "f"), value);
  }
}

TEST(SurfaceFeature, texts_of_other_programs_are_understood) {
  const std::vector<SurfaceFeature> line{{3, {{0, 0, 1}, {2.5, 0, 1}}}};
  EXPECT_EQ(parse_features(" 3 LINESTRING Z (0 0 1, 2.5 0 1) ", true), line);
  EXPECT_EQ(parse_features("3 linestring z(0 0 1,2.5 0 1);", true), line);
  EXPECT_EQ(parse_features("3 LINESTRINGZ(0 0 1e0 ,25e-1 0 1)", true), line);
  EXPECT_EQ(parse_features("4 POINT Z (1 -2 3); 5 POINT Z (0 0 0)", false),
            (std::vector<SurfaceFeature>{{4, {{1, -2, 3}}}, {5, {{0, 0, 0}}}}));
}

TEST(SurfaceFeature, what_is_none_is_refused) {
  for (const char* text :
       {"", ";", "3", "LINESTRING Z (0 0 1, 1 0 0)", "3 LINESTRING (0 0, 1 1)",
        "3 LINESTRING Z (0 0 1)", "3 LINESTRING Z (0 0 1, 0 0 1)", "3 LINESTRING Z (0 0 1, 1 0 0",
        "3 LINESTRING Z (0 0 nan, 1 0 0)", "3 LINESTRING Z (0 0 inf, 1 0 0)",
        "0 LINESTRING Z (0 0 1, 1 0 0)", "-3 LINESTRING Z (0 0 1, 1 0 0)",
        "3 LINESTRING Z (0 0 1e13, 1 0 0)", "3 LINESTRING Z (0 0 1, 1 0 0) x", "3 POINT Z (0 0 1)"})
    EXPECT_EQ(parse_features(text, true), std::nullopt) << text;
  for (const char* text : {R"({})", R"([1])", R"([{"model": 3}])",
                           R"([{"model": "3", "coordinates": [[0,0,0],[1,0,0]]}])",
                           R"([{"model": 3, "coordinates": [[0,0,0]]}])",
                           R"([{"model": 3, "coordinates": [[0,0],[1,0]]}])",
                           R"([{"model": 3, "coordinates": [[0,0,0],[1,0,"1"]]}])",
                           R"([{"model": 3, "coordinates": [[0,0,0],[1,0,2e12]]}])",
                           R"([{"model": 3, "coordinates": [[0,0,0],[1,0,0]], "more": 1}])",
                           R"([{"model": 0, "coordinates": [[0,0,0],[1,0,0]]}])"})
    EXPECT_EQ(read_features(json::parse(text), true), std::nullopt) << text;
  const Column column = column_of(ColumnKind::line);
  for (const json& value : {json("x"), json(3), json(true), json::object(), json::array({1, 2})}) {
    const auto checked = check_value(column, value, "values.crack");
    ASSERT_FALSE(checked) << value;
    EXPECT_EQ(checked.error().field, "values.crack");
  }
  EXPECT_EQ(check_value(column, json::array(), "f"), json()) << "a list of none is no value";
  // Limits: the number of features, and the total number of their points.
  std::vector<SurfaceFeature> many(kMaxFeatures + 1, {1, {{0, 0, 0}}});
  EXPECT_EQ(read_features(to_json(many), false), std::nullopt);
  many.resize(kMaxFeatures);
  EXPECT_TRUE(read_features(to_json(many), false));
  const std::vector<SurfaceFeature> long_ones(
      2, {1, std::vector<glm::dvec3>(kMaxFeaturePlaces / 2 + 1, {1, 2, 3})});
  EXPECT_EQ(read_features(to_json(long_ones), true), std::nullopt);
}

TEST(SurfaceFeature, a_line_is_as_long_as_its_parts) {
  EXPECT_DOUBLE_EQ(length_of({1, {{0, 0, 0}, {3, 4, 0}, {3, 4, 12}}}), 17);
  EXPECT_EQ(length_of({1, {{5, 5, 5}}}), 0);
}

TEST(SurfaceFeature, columns_of_marks_have_no_default_and_are_not_unique) {
  for (const auto kind : {ColumnKind::line, ColumnKind::point}) {
    Column column = column_of(kind);
    EXPECT_TRUE(check_column(column));
    column.unique = true;
    EXPECT_EQ(check_column(column).error().field, "unique");
    column.unique = false;
    column.default_value = json::array({{{"model", 1}, {"coordinates", {{0, 0, 0}, {1, 1, 1}}}}});
    EXPECT_EQ(check_column(column).error().field, "default");
    EXPECT_EQ(parse_column_kind(name(kind)), kind);
  }
  // A column of lines can become a text column, and a text column can become a column of lines.
  const json line = to_json(std::vector<SurfaceFeature>{{3, {{0, 0, 1}, {2.5, 0, 1}}}});
  EXPECT_EQ(convert_value(column_of(ColumnKind::line), column_of(ColumnKind::text), line, "f"),
            json("3 LINESTRING Z (0 0 1, 2.5 0 1)"));
  const auto again = convert_value(column_of(ColumnKind::text), column_of(ColumnKind::line),
                                   "3 LINESTRING Z (0 0 1, 2.5 0 1)", "f");
  ASSERT_TRUE(again) << again.error().detail;
  EXPECT_EQ(*again, line);
  EXPECT_FALSE(convert_value(column_of(ColumnKind::integer), column_of(ColumnKind::line), 3, "f"));
}

}  // namespace
}  // namespace strata
