// LAS files, written byte by byte from the specification (ASPRS LAS 1.4, R15).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "mesh/io/load_formats.h"

namespace {

using namespace strata;
using testing::HasSubstr;

struct Point {
  std::int32_t x, y, z;
  int classification = 2;
  bool withheld = false;
  std::array<std::uint16_t, 3> rgb{};
};

class LasFile {
 public:
  int minor = 2, format = 0;
  std::array<double, 3> scale{0.001, 0.001, 0.001}, offset{};
  std::vector<std::pair<int, std::string>> projection;  // record id and content
  std::vector<Point> points;
  int extra_bytes = 0;  // after each record
  std::int64_t announced = -1;

  std::string bytes() const {
    static constexpr int kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
    static constexpr int kRgb[] = {-1, -1, 20, 28, -1, 28, -1, 30, 30, -1, 30};
    const int header_bytes = minor >= 4 ? 375 : minor == 3 ? 235 : 227;
    std::string records;
    for (const auto& [id, content] : projection) {
      std::string record(54, '\0');
      record.replace(2, 15, "LASF_Projection");
      put<std::uint16_t>(record, 18, id);
      put<std::uint16_t>(record, 20, content.size());
      records += record + content;
    }
    std::string file(header_bytes, '\0');
    file.replace(0, 4, "LASF");
    put<std::uint8_t>(file, 24, 1);
    put<std::uint8_t>(file, 25, minor);
    put<std::uint16_t>(file, 94, header_bytes);
    put<std::uint32_t>(file, 96, header_bytes + records.size());
    put<std::uint32_t>(file, 100, projection.size());
    put<std::uint8_t>(file, 104, format);
    const int stride = kBytes[format & 15] + extra_bytes;
    put<std::uint16_t>(file, 105, stride);
    const std::uint64_t count = announced < 0 ? points.size() : std::uint64_t(announced);
    if (minor < 4) put<std::uint32_t>(file, 107, count);
    if (minor >= 4) put<std::uint64_t>(file, 247, count);
    for (int k = 0; k < 3; ++k) put<double>(file, 131 + 8 * k, scale[k]);
    for (int k = 0; k < 3; ++k) put<double>(file, 155 + 8 * k, offset[k]);
    file += records;
    for (const Point& p : points) {
      std::string record(stride, '\0');
      put<std::int32_t>(record, 0, p.x);
      put<std::int32_t>(record, 4, p.y);
      put<std::int32_t>(record, 8, p.z);
      const bool is_long = (format & 15) >= 6;
      put<std::uint8_t>(record, is_long ? 16 : 15,
                        is_long ? p.classification : p.classification | (p.withheld ? 0x80 : 0));
      if (is_long && p.withheld) put<std::uint8_t>(record, 15, 0x04);
      if (kRgb[format & 15] >= 0)
        for (int k = 0; k < 3; ++k) put<std::uint16_t>(record, kRgb[format & 15] + 2 * k, p.rgb[k]);
      file += record;
    }
    return file;
  }

 private:
  template <class T>
  static void put(std::string& text, std::size_t at, auto value) {
    const T narrow = static_cast<T>(value);
    std::memcpy(text.data() + at, &narrow, sizeof narrow);
  }
};

std::string keys(std::initializer_list<std::array<std::uint16_t, 4>> all) {
  std::string content;
  const std::array<std::uint16_t, 4> head{1, 1, 0, std::uint16_t(all.size())};
  content.append(reinterpret_cast<const char*>(head.data()), 8);
  for (const auto& key : all) content.append(reinterpret_cast<const char*>(key.data()), 8);
  return content;
}

Result<mesh::LoadedMesh> parse(const std::string& file) {
  Progress progress;
  std::vector<mesh::InputFiles::Entry> entries;
  entries.push_back(
      {"a.las", {reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, std::nullopt});
  const auto files = mesh::InputFiles::of(std::move(entries), "/tmp", progress);
  return mesh::parse_las(*files, progress);
}

class LasFormats : public testing::TestWithParam<int> {};

TEST_P(LasFormats, coordinates_are_scaled_and_shifted) {
  LasFile las;
  las.format = GetParam();
  las.minor = las.format >= 6 ? 4 : 3;
  las.extra_bytes = 5;
  las.offset = {500'000, 5'400'000, 100};
  las.points = {{1000, -2000, 3}, {2147483647, -2147483647 - 1, 0}};
  const auto loaded = parse(las.bytes());
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_EQ(loaded->mesh.positions.size(), 2u);
  EXPECT_EQ(loaded->mesh.positions[0], glm::dvec3(500'001, 5'399'998, 100.003));
  EXPECT_NEAR(loaded->mesh.positions[1].x, 500'000 + 2147483.647, 1e-6);
  EXPECT_TRUE(loaded->mesh.vertex_colors.empty());
  EXPECT_TRUE(loaded->crs.empty());
}

TEST_P(LasFormats, withheld_points_and_noise_are_left_out) {
  LasFile las;
  las.format = GetParam();
  las.minor = las.format >= 6 ? 4 : 2;
  las.points = {{1, 0, 0}, {2, 0, 0, 7}, {3, 0, 0, 2, true}, {4, 0, 0, 6}};
  if (las.format >= 6) las.points.push_back({5, 0, 0, 18});
  const auto loaded = parse(las.bytes());
  ASSERT_TRUE(loaded) << loaded.error().detail;
  ASSERT_EQ(loaded->mesh.positions.size(), 2u);
  EXPECT_DOUBLE_EQ(loaded->mesh.positions[1].x, 0.004);
  ASSERT_EQ(loaded->repairs.size(), 1u);
  EXPECT_EQ(loaded->repairs[0].count, las.points.size() - 2);
}
INSTANTIATE_TEST_SUITE_P(all, LasFormats, testing::Range(0, 11));

TEST(Las, colors_of_16_and_of_8_bits_are_read) {
  for (const int format : {2, 3, 5, 7, 8, 10})
    for (const int scale : {257, 1}) {
      LasFile las;
      las.format = format;
      las.minor = 4;
      const auto c = [&](int value) { return std::uint16_t(value * scale); };
      las.points = {{0, 0, 0, 2, false, {c(255), c(0), c(10)}},
                    {1, 0, 0, 2, false, {c(1), c(2), c(3)}}};
      const auto loaded = parse(las.bytes());
      ASSERT_TRUE(loaded) << loaded.error().detail;
      EXPECT_THAT(loaded->mesh.vertex_colors, testing::ElementsAre(0xff0a00ffu, 0xff030201u))
          << format << " " << scale;
    }
}

TEST(Las, the_coordinate_system_comes_from_geotiff_keys) {
  LasFile las;
  las.points = {{0, 0, 0}};
  las.projection = {{34735, keys({{1024, 0, 1, 1}, {2048, 0, 1, 4258}, {3072, 0, 1, 25832}})}};
  auto loaded = parse(las.bytes());
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->crs, "EPSG:25832");
  EXPECT_EQ(loaded->unit, Unit::m);

  las.projection = {{34735, keys({{1024, 0, 1, 1}, {3072, 0, 1, 2225}, {3076, 0, 1, 9003}})}};
  loaded = parse(las.bytes());
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->crs, "EPSG:2225");
  EXPECT_FALSE(loaded->unit) << "the coordinates are in feet";

  las.projection = {{34735, keys({{1024, 0, 1, 2}, {2048, 0, 1, 4326}})}};
  loaded = parse(las.bytes());
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("degrees"));
}

TEST(Las, the_coordinate_system_comes_from_wkt) {
  LasFile las;
  las.minor = 4;
  las.format = 6;
  las.points = {{0, 0, 0}};
  const std::string projected =
      R"(PROJCS["ETRS89 / UTM zone 32N",GEOGCS["ETRS89",DATUM["x",SPHEROID["GRS 1980",6378137,298.25,)"
      R"(AUTHORITY["EPSG","7019"]]],AUTHORITY["EPSG","4258"]],UNIT["metre",1],AUTHORITY["EPSG","25832"]])";
  las.projection = {{2112, projected}};
  auto loaded = parse(las.bytes());
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->crs, "EPSG:25832");
  EXPECT_EQ(loaded->unit, Unit::m);

  las.projection = {
      {2112, "COMPD_CS[\"a + b\"," + projected +
                 R"(,VERT_CS["b",AUTHORITY["EPSG","7837"]],AUTHORITY["EPSG","5555"]])"}};
  loaded = parse(las.bytes());
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->crs, "EPSG:25832") << "of the horizontal part";

  las.projection = {
      {2112, R"(PROJCRS["own",BASEGEOGCRS["g",ID["EPSG",4258]],LENGTHUNIT["foot",0.3]])"}};
  loaded = parse(las.bytes());
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->crs, "") << "the code of a part is not that of the whole";
  EXPECT_FALSE(loaded->unit);

  las.projection = {{2112, R"(GEOGCS["WGS 84",AUTHORITY["EPSG","4326"]])"}};
  loaded = parse(las.bytes());
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().detail, HasSubstr("degrees"));
}

TEST(Las, faults_are_refused_by_name) {
  LasFile good;
  good.points = {{0, 0, 0}, {1, 1, 1}};
  LasFile compressed = good, cut = good, flat = good, future = good;
  compressed.format = 0x80 | 2;
  cut.announced = 3;
  flat.scale = {0, 1, 1};
  future.minor = 5;
  std::string short_record = good.bytes(), far = good.bytes(), odd = good.bytes();
  odd[104] = 11;
  short_record[105] = 19;
  far[99] = '\x7f';
  const std::pair<std::string, std::string> bad[] = {
      {compressed.bytes(), "compressed (LAZ)"},
      {cut.bytes(), "it has 2 of 3 points"},
      {flat.bytes(), "scale"},
      {future.bytes(), "LAS 1.5"},
      {short_record, "19 bytes"},
      {far, "wrong position"},
      {odd, "point format 11"},
      {"LASF", "cut off"},
  };
  for (const auto& [file, says] : bad) {
    const auto loaded = parse(file);
    ASSERT_FALSE(loaded) << says;
    EXPECT_EQ(loaded.error().code, ErrorCode::invalid);
    EXPECT_THAT(loaded.error().detail, HasSubstr(says));
  }
}

// With the address sanitizer, this shows that the reader stays within the file.
TEST(Las, every_beginning_of_a_file_and_every_changed_byte_is_safe) {
  LasFile las;
  las.format = 3;
  las.projection = {{34735, keys({{1024, 0, 1, 1}, {3072, 0, 1, 25832}})}, {2112, "PROJCS[\"\"]"}};
  las.points.assign(4, {1, 2, 3});
  const std::string whole = las.bytes();
  ASSERT_TRUE(parse(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) parse(whole.substr(0, size));
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char value : {'\0', '\x7f', '\xff'}) {
      std::string changed = whole;
      changed[at] = value;
      parse(changed);
    }
}

}  // namespace
