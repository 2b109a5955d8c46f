#include "query/maps/flat_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "query/maps/geojson.h"
#include "query/rasters/placed_picture.h"

namespace strata::query {
namespace {

const std::string kSquare =
    R"({"type":"Polygon","coordinates":[[[0,0],[10,0],[10,10],[0,10],[0,0]]]})";

std::string feature(const std::string& geometry, const std::string& properties) {
  return R"({"type":"Feature","geometry":)" + geometry + R"(,"properties":)" + properties + "}";
}
std::string collection(const std::string& features) {
  return R"({"type":"FeatureCollection","features":[)" + features + "]}";
}

Result<FlatMap> parse_map(const std::string& text, const std::string& attribute, double value) {
  const auto features = parse_geojson(text);
  if (!features) return tl::unexpected(features.error());
  return flat_map(*features, {attribute, value, ""}, nullptr);
}

TEST(FlatMap, polygons_are_read_with_their_holes_and_the_value_of_an_attribute) {
  const std::string holed =
      R"({"type":"MultiPolygon","coordinates":[[[[20,0,5],[30,0,5],[30,10,5],[20,10,5],[20,0,5]],[[24,4],[26,4],[26,6],[24,6],[24,4]]],
         [[[40,0],[50,0],[45,10]]]]})";
  const auto areas =
      parse_map(collection(feature(kSquare, R"({"unit":3,"name":"a"})") + "," +
                           feature(holed, R"({"unit":7.5})") + "," + feature("null", "{}")),
                "unit", 0);
  ASSERT_TRUE(areas) << areas.error().detail;
  ASSERT_EQ(areas->areas().size(), 3u);
  EXPECT_EQ(areas->value_at({5, 5}), 3);
  EXPECT_EQ(areas->value_at({21, 5}), 7.5);
  EXPECT_EQ(areas->value_at({25, 5}), std::nullopt);
  EXPECT_EQ(areas->value_at({45, 2}), 7.5);
  EXPECT_EQ(areas->value_at({15, 5}), std::nullopt);
}

TEST(FlatMap, without_an_attribute_all_have_the_stated_value_and_later_ones_lie_on_top) {
  const auto bare = parse_map(kSquare, "", 9);
  ASSERT_TRUE(bare);
  EXPECT_EQ(bare->value_at({5, 5}), 9);
  const std::string small = R"({"type":"Polygon","coordinates":[[[4,4],[6,4],[6,6],[4,6]]]})";
  const auto areas = parse_map(
      collection(feature(kSquare, R"({"v":1})") + "," + feature(small, R"({"v":2})")), "v", 0);
  ASSERT_TRUE(areas);
  EXPECT_EQ(areas->value_at({5, 5}), 2);
  EXPECT_EQ(areas->value_at({1, 5}), 1);
}

TEST(FlatMap, that_cannot_be_read_is_refused_with_the_place) {
  struct Case {
    std::string text, field, says;
  };
  const std::vector<Case> cases{
      {"", "body", "not JSON"},
      {"{", "body", "not JSON"},
      {"[]", "body", "`type`"},
      {"{}", "body", "`type`"},
      {R"({"type":7})", "body", "`type`"},
      {R"({"type":"Topology"})", "body", "only Polygon and MultiPolygon"},
      {R"({"type":"FeatureCollection"})", "body", "`features`"},
      {collection("7"), "body.features[0]", "`type`"},
      {R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":null,"properties":{"v":1}}]})",
       "attribute", "It has no attributes"},
      {collection(R"({"type":"Feature"})"), "body.features[0]", "`geometry`"},
      {collection(feature(kSquare, "null")), "attribute", "no attribute 'v'. It has no attributes"},
      {collection(feature(kSquare, R"({"w":3})")), "attribute", "Its attributes are w"},
      {collection(feature(kSquare, R"({"v":null})")), "body",
       "body.features[0]: the attribute 'v' does not contain a number"},
      {collection(feature(kSquare, R"({"v":"3"})")), "body", "instead of a number"},
      {collection(feature(R"({"type":"Point","coordinates":[1,2]})", R"({"v":1})")),
       "body.features[0].geometry", "not Point"},
      {R"({"type":"Polygon"})", "body.coordinates", "list of rings"},
      {R"({"type":"Polygon","coordinates":[]})", "body.coordinates", "list of rings"},
      {R"({"type":"Polygon","coordinates":[[[0,0],[1,1]]]})", "body.coordinates[0]",
       "three points"},
      {R"({"type":"Polygon","coordinates":[[[0,0],[1],[1,1]]]})", "body.coordinates[0][1]",
       "list of numbers"},
      {R"({"type":"Polygon","coordinates":[[[0,0],["1",2],[1,1]]]})", "body.coordinates[0][1]",
       "list of numbers"},
      {R"({"type":"MultiPolygon","coordinates":{"a":1}})", "body", "list of polygons"},
      {std::string(100'000, '['), "body", "nested"},
  };
  for (const Case& c : cases) {
    const auto areas = parse_map(c.text, "v", 0);
    ASSERT_FALSE(areas) << c.text.substr(0, 80);
    EXPECT_THAT(areas.error().detail, testing::HasSubstr(c.says)) << c.text.substr(0, 80);
    EXPECT_EQ(areas.error().field, c.field) << c.text.substr(0, 80);
  }
}

TEST(FlatMap, a_map_without_polygons_is_refused) {
  for (const std::string& text : {collection(""), collection(feature("null", "{}"))}) {
    const auto map = parse_map(text, "", 1);
    ASSERT_FALSE(map);
    EXPECT_THAT(map.error().detail, testing::HasSubstr("no polygon"));
  }
}

TEST(FlatMap, of_thousands_of_areas_the_same_one_is_found_as_by_asking_all) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(0, 100), size(0.1, 8);
  std::vector<MapArea> areas;
  for (int i = 0; i < 3000; ++i) {
    const double x = place(random), y = place(random), w = size(random), h = size(random);
    areas.push_back({PolygonArea({{{x, y}, {x + w, y}, {x + w / 2, y + h}}}), double(i)});
  }
  areas.push_back({PolygonArea({{{-50, -50}, {150, -50}, {150, 20}, {-50, 20}}}), -1});
  const FlatMap map(areas);
  int inside = 0;
  for (int i = 0; i < 20'000; ++i) {
    const glm::dvec2 point(place(random) * 1.2 - 10, place(random) * 1.2 - 10);
    std::optional<double> expected;
    for (const MapArea& each : areas)
      if (each.area.contains(point)) expected = each.value;
    ASSERT_EQ(map.value_at(point), expected) << point.x << ' ' << point.y;
    inside += expected.has_value();
  }
  EXPECT_GT(inside, 5000);
}

TEST(FlatMap, a_world_file_is_six_numbers) {
  for (const char* text : {"0.5,0,0,-0.5,100,200", "0.5\r\n0\r\n0\r\n-0.5\r\n100\r\n200\r\n",
                           " 0.5 0 0 -0.5 100 2e2 "}) {
    const auto world = parse_world_file(text, "world");
    ASSERT_TRUE(world) << text;
    EXPECT_EQ(world->x_per_column, 0.5);
    EXPECT_EQ(world->y_per_row, -0.5);
    EXPECT_EQ(world->y, 200);
  }
  for (const char* text : {"", "1,0,0,-1,0", "1,0,0,-1,0,0,0", "1,0,0,-1,0,x", "1,0,0,nan,0,0",
                           "1,0,0,-1,0,1e999", "1;0;0;-1;0;0", "0,0,0,-1,0,0", "1,1,1,1,0,0"}) {
    const auto world = parse_world_file(text, "world");
    ASSERT_FALSE(world) << text;
    EXPECT_EQ(world.error().field, "world");
  }
}

TEST(FlatMap, a_picture_stands_where_its_world_file_says) {
  Picture picture{3, 2, {}};
  for (const int grey : {10, 20, 30, 40, 50, 60}) {
    const auto value = static_cast<std::uint8_t>(grey);
    const std::uint8_t alpha = grey == 60 ? 0 : 255;
    picture.rgba.insert(picture.rgba.end(), {value, value, value, alpha});
  }
  // The pixels have a side of 2 units. The center of the first pixel is at (101, 199), and rows go
  // downwards.
  const PlacedPicture placed(picture, {2, 0, 0, -2, 101, 199});
  EXPECT_EQ(placed.luminance_at({100.1, 199.9}), 10);
  EXPECT_EQ(placed.luminance_at({103, 199}), 20);
  EXPECT_EQ(placed.luminance_at({105.9, 198.1}), 30);
  EXPECT_EQ(placed.luminance_at({101, 197}), 40);
  EXPECT_EQ(placed.luminance_at({105, 197}), std::nullopt) << "transparent";
  for (const glm::dvec2 outside : {glm::dvec2(99.9, 199), {106.1, 199}, {101, 200.1}, {101, 195.9}})
    EXPECT_EQ(placed.luminance_at(outside), std::nullopt);
  // The image is rotated by 90°: columns go along +y, and rows along +x.
  const PlacedPicture turned(picture, {0, 2, 2, 0, 0, 0});
  EXPECT_EQ(turned.luminance_at({0, 2}), 20);
  EXPECT_EQ(turned.luminance_at({2, 0}), 40);
}

TEST(FlatMap, colours_count_by_their_luminance) {
  Picture picture{3, 1, {255, 0, 0, 255, 0, 255, 0, 255, 255, 255, 255, 255}};
  const PlacedPicture placed(picture, {1, 0, 0, -1, 0, 0});
  EXPECT_EQ(placed.luminance_at({0, 0}), 54);
  EXPECT_EQ(placed.luminance_at({1, 0}), 182);
  EXPECT_EQ(placed.luminance_at({2, 0}), 255);
}

}  // namespace
}  // namespace strata::query
