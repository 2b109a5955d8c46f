#include "query/maps/wkt.h"

#include <gtest/gtest.h>

namespace strata::query {
namespace {

using Kind = WktGeometry::Kind;

TEST(Wkt, each_kind_of_geometry_is_read) {
  const auto point = parse_wkt("POINT(1.5 -2)", "coords");
  ASSERT_TRUE(point);
  EXPECT_EQ(point->kind, Kind::points);
  EXPECT_FALSE(point->has_heights);
  EXPECT_EQ(point->parts.at(0).rings.at(0), (FlatRing{{1.5, -2, 0}}));

  const auto high = parse_wkt("multipoint z ((1 2 3), (4 5 6))", "coords");
  ASSERT_TRUE(high);
  EXPECT_TRUE(high->has_heights);
  EXPECT_EQ(high->parts.at(1).rings.at(0), (FlatRing{{4, 5, 6}}));

  const auto line = parse_wkt("LINESTRING(0 0, 1 2, 3 4)", "coords");
  ASSERT_TRUE(line);
  EXPECT_EQ(line->kind, Kind::line);
  EXPECT_EQ(line->parts.at(0).rings.at(0).size(), 3u);

  const auto area = parse_wkt(
      "MULTIPOLYGON(((0 0, 9 0, 9 9, 0 0), (2 1, 3 1, 3 2, 2 1)), ((20 0, 21 0, 21 1, 20 0)))",
      "coords");
  ASSERT_TRUE(area);
  EXPECT_EQ(area->kind, Kind::areas);
  ASSERT_EQ(area->parts.size(), 2u);
  EXPECT_EQ(area->parts[0].rings.size(), 2u);
  EXPECT_EQ(area->parts[0].rings[0].size(), 3u) << "the first corner is not repeated";
}

TEST(Wkt, other_texts_are_refused) {
  for (const char* text :
       {"", "POINT", "POINT(1)", "POINT(a b)", "POINT EMPTY", "LINESTRING(1 2)", "POINT(nan 1)",
        "POINT(inf 1)", "POLYGON((0 0, 1 1))", "POLYGON((0 0, 1 0, 1 1, 0 1))", "POINT(1 2) 3",
        "GEOMETRYCOLLECTION(POINT(1 2))", "MULTILINESTRING((0 0, 1 1))"}) {
    const auto read = parse_wkt(text, "coords");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::malformed);
    EXPECT_EQ(read.error().field, "coords");
  }
  EXPECT_FALSE(parse_wkt(std::string(5000, '('), "coords"));
}

}  // namespace
}  // namespace strata::query
