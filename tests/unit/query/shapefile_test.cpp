#include "query/maps/shapefile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/shape_files.h"

namespace strata::query {
namespace {

using test::dbf_of;
using test::polygon_record;
using test::shp_of;
using test::square;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

Result<FeatureMap> parse(const std::string& shp, const std::string& dbf = "",
                         const std::string& cpg = "", const std::string& prj = "") {
  return parse_shapefile({bytes_of(shp), bytes_of(dbf), cpg, prj});
}

const std::vector<std::string> kThree{polygon_record(square(0, 0, 10)), polygon_record({}),
                                      polygon_record({square(20, 0, 10)[0],
                                                      {{24, 4}, {26, 4}, {26, 6}, {24, 6}, {24, 4}},
                                                      square(40, 0, 5)[0]})};

TEST(Shapefile, polygons_are_read_with_their_holes_and_attributes_of_every_type) {
  const auto map = parse(shp_of(kThree), dbf_of({{"UNIT", 'N', 8, 0, {"3", "5", "-7"}},
                                                 {"DEPTH", 'F', 10, 3, {"0.250", "", "1.5e2"}},
                                                 {"NAME",
                                                  'C',
                                                  12,
                                                  0,
                                                  {"salt", "none",
                                                   "cr\xc3\xa4"
                                                   "ck"}},
                                                 {"SEEN", 'L', 1, 0, {"T", "F", "n"}}}));
  ASSERT_TRUE(map) << map.error().detail;
  EXPECT_THAT(map->columns, testing::ElementsAre("UNIT", "DEPTH", "NAME", "SEEN"));
  ASSERT_EQ(map->features.size(), 2u) << "the null shape is passed over";
  using V = MapValue;
  EXPECT_THAT(map->features[0].values, testing::ElementsAre(V(3.0), V(0.25), V("salt"), V(1.0)));
  EXPECT_THAT(map->features[1].values, testing::ElementsAre(V(-7.0), V(150.0),
                                                            V("cr\xc3\xa4"
                                                              "ck"),
                                                            V(0.0)));
  EXPECT_EQ(map->features[1].place, "Record 3");
  const auto flat = flat_map(*map, {"UNIT", 0, ""}, nullptr);
  ASSERT_TRUE(flat) << flat.error().detail;
  EXPECT_EQ(flat->value_at({5, 5}), 3);
  EXPECT_EQ(flat->value_at({21, 5}), -7);
  EXPECT_EQ(flat->value_at({25, 5}), std::nullopt) << "a hole";
  EXPECT_EQ(flat->value_at({42, 2}), -7) << "the second part";
  EXPECT_EQ(flat->value_at({35, 2}), std::nullopt);
}

TEST(Shapefile, it_works_without_attributes_and_with_heights) {
  const auto bare = parse(shp_of({polygon_record(square(0, 0, 1), 15)}, 15));
  ASSERT_TRUE(bare) << bare.error().detail;
  EXPECT_TRUE(bare->columns.empty());
  EXPECT_EQ(flat_map(*bare, {"", 4, ""}, nullptr)->value_at({0.5, 0.5}), 4);
  const auto none = parse(shp_of({}));
  ASSERT_TRUE(none) << none.error().detail;
  EXPECT_FALSE(flat_map(*none, {"", 4, ""}, nullptr));
}

TEST(Shapefile, texts_are_in_the_encoding_that_it_says) {
  const auto shp = shp_of({polygon_record(square(0, 0, 1))});
  const auto name = [&](const std::string& text, const std::string& cpg) {
    const auto map = parse(shp, dbf_of({{"NAME", 'C', 12, 0, {text}}}), cpg);
    return map ? std::get<std::string>(map->features[0].values[0]) : map.error().detail;
  };
  EXPECT_EQ(name("Gr\xfcn", "1252"), "Grün");
  EXPECT_EQ(name("Gr\xfcn", "ISO-8859-1"), "Grün");
  EXPECT_EQ(name("Gr\x81n", "850"), "Grün");
  EXPECT_EQ(name("Grün", "UTF-8"), "Grün");
  EXPECT_EQ(name("Grün", ""), "Grün");
  EXPECT_EQ(name("Gr\xfcn", ""), "Grün");
  EXPECT_EQ(name("Gr\xfcn", "nonsense"), "Grün");
}

TEST(Shapefile, names_become_keys_that_the_legend_has_or_gets) {
  const auto map = parse(shp_of(kThree), dbf_of({{"NAME", 'C', 12, 0, {"salt", "none", "crack"}}}));
  ASSERT_TRUE(map);
  Palette legend{PaletteMode::categorical, 1, 7, {{1, {}, "crack"}, {2, {}, ""}, {3, {}, ""}}, {}};
  KeyNames keys(legend, {2});
  const auto flat = flat_map(*map, {"NAME", 0, ""}, &keys);
  ASSERT_TRUE(flat) << flat.error().detail;
  EXPECT_EQ(flat->value_at({21, 5}), 1) << "crack has its key";
  EXPECT_EQ(flat->value_at({5, 5}), 3) << "1 has a name and 2 is used without one";
  EXPECT_THAT(keys.added_names(), testing::ElementsAre("salt"));
  const Palette extended = keys.extended();
  ASSERT_EQ(extended.points.size(), 3u);
  EXPECT_EQ(extended.points[2].label, "salt");

  const auto refused = flat_map(*map, {"NAME", 0, ""}, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().detail, testing::HasSubstr("categorical"));
}

TEST(Shapefile, numbers_take_names_from_another_attribute) {
  const auto map = parse(shp_of(kThree), dbf_of({{"ID", 'N', 4, 0, {"8", "9", "1"}},
                                                 {"NAME", 'C', 12, 0, {"salt", "none", "crack"}}}));
  ASSERT_TRUE(map);
  KeyNames keys({PaletteMode::categorical, 1, 7, {{1, {}, "moss"}}, {}}, {});
  ASSERT_TRUE(flat_map(*map, {"ID", 0, "NAME"}, &keys));
  const auto points = keys.extended().points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].label, "moss") << "what the legend says stays";
  EXPECT_EQ(points[1].at, 8);
  EXPECT_EQ(points[1].label, "salt");
}

TEST(Shapefile, the_attributes_to_choose_from_are_told) {
  const auto map = parse(shp_of(kThree), dbf_of({{"ID", 'N', 4, 0, {"8", "9", "1"}},
                                                 {"NAME", 'C', 12, 0, {"salt", "none", "crack"}},
                                                 {"SOME", 'N', 4, 0, {"8", "9", ""}}}));
  ASSERT_TRUE(map);
  const auto columns = columns_of(*map);
  ASSERT_EQ(columns.size(), 3u);
  EXPECT_TRUE(columns[0].is_number && !columns[0].is_text);
  EXPECT_TRUE(columns[1].is_text && !columns[1].is_number);
  EXPECT_FALSE(columns[2].is_number || columns[2].is_text) << "one record has none";
  EXPECT_THAT(columns[0].samples, testing::ElementsAre("8", "1"));
  const auto missing = flat_map(*map, {"SOME", 0, ""}, nullptr);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().detail,
              testing::HasSubstr("Record 3: the attribute 'SOME' does not contain a number"));
  const auto unknown = flat_map(*map, {"DEPTH", 0, ""}, nullptr);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().field, "attribute");
  EXPECT_THAT(unknown.error().detail, testing::HasSubstr("ID, NAME, SOME"));
}

TEST(Shapefile, its_coordinate_system_is_told) {
  const auto shp = shp_of({polygon_record(square(0, 0, 1))});
  EXPECT_EQ(
      parse(
          shp, "", "",
          R"(PROJCS["ETRS89 / UTM zone 30N",GEOGCS["x",AUTHORITY["EPSG","4258"]],AUTHORITY["EPSG","25830"]])")
          ->crs,
      "EPSG:25830");
  EXPECT_EQ(
      parse(shp, "", "", R"(PROJCS["mine",GEOGCS["x",AUTHORITY["EPSG","4258"]],UNIT["m",1]])")->crs,
      "");
  EXPECT_TRUE(parse(shp, "", "", R"(GEOGCS["WGS 84"])")->in_degrees);
}

TEST(Shapefile, that_cannot_be_read_is_refused_with_the_reason) {
  const std::string good = shp_of(kThree);
  const std::string dbf = dbf_of({{"ID", 'N', 4, 0, {"8", "9", "1"}}});
  const auto patched = [](std::string file, std::size_t at, const std::string& bytes) {
    return file.replace(at, bytes.size(), bytes);
  };
  struct Case {
    std::string shp, dbf, says;
  };
  const std::vector<Case> cases{
      {"", "", "not a shapefile"},
      {good.substr(0, 60), "", "not a shapefile"},
      {patched(good, 0, "nope"), "", "not a shapefile"},
      {shp_of({}, 1), "", "contains points"},
      {shp_of({}, 3), "", "contains lines"},
      {shp_of({}, 31), "", "contains multipatches"},
      {shp_of({}, 77), "", "type 77"},
      {good.substr(0, good.size() - 8), "", "incomplete"},
      {patched(good, 104, test::big_endian(0x7fffffff)), "", "Record 1 of the .shp is longer"},
      {patched(good, 104, test::big_endian(0)), "", "Record 1 of the .shp is longer"},
      {patched(good, 108, test::little_endian(3)), "", "Record 1 of the .shp has another type"},
      {patched(good, 108 + 36, test::little_endian(0x7fffffff)), "",
       "Record 1 of the .shp cannot be read"},
      {patched(good, 108 + 40, test::little_endian(0x7fffffff)), "",
       "Record 1 of the .shp cannot be read"},
      {patched(good, 108 + 44, test::little_endian(0x7fffffff)), "", "Record 1 of the .shp"},
      {shp_of({polygon_record({{{0, 0}, {1, 1}}})}), "", "fewer than three"},
      {shp_of({polygon_record({{{0, 0}, {1, NAN}, {1, 1}}})}), "", "finite"},
      {good, "x", ".dbf is incomplete"},
      {good, dbf.substr(0, dbf.size() - 4), ".dbf is incomplete"},
      {good, patched(dbf, 4, test::little_endian(0x7fffffff)), ".dbf is incomplete"},
      {good, patched(dbf, 8, std::string(4, '\0')), "header has no fields"},
      {good, dbf_of({{"ID", 'N', 4, 0, {"8", "9"}}}), "do not belong together"},
  };
  for (const Case& c : cases) {
    const auto map = parse(c.shp, c.dbf);
    ASSERT_FALSE(map) << c.says;
    EXPECT_EQ(map.error().code, ErrorCode::invalid);
    EXPECT_THAT(map.error().detail, testing::HasSubstr(c.says));
  }
}

// Changes every byte of small files in turn, and truncates them to every length. The reader must
// return a map or an error.
TEST(Shapefile, damaged_anywhere_it_is_read_or_refused) {
  const std::string shp = shp_of(kThree), dbf = dbf_of({{"ID", 'N', 4, 0, {"8", "9", "1"}},
                                                        {"T", 'C', 4, 0, {"a", "b", "c"}}});
  int refused = 0;
  for (const char change : {'\x00', '\x7f', '\xff'}) {
    for (std::size_t i = 0; i < shp.size(); ++i) {
      std::string damaged = shp;
      damaged[i] = change;
      refused += !parse(damaged, dbf);
    }
    for (std::size_t i = 0; i < dbf.size(); ++i) {
      std::string damaged = dbf;
      damaged[i] = change;
      refused += !parse(shp, damaged);
    }
  }
  for (std::size_t length = 0; length < shp.size(); ++length)
    EXPECT_FALSE(parse(shp.substr(0, length), dbf));
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace strata::query
