#include "query/maps/map_tiff.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/tiff_files.h"

namespace strata::query {
namespace {

using test::TiffFile;

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}
Result<MapTiff> inspect(const std::string& file) { return inspect_tiff(bytes_of(file), 1000); }

TiffFile grey(std::vector<TiffFile::Tag> more = {}) {
  return {3, 2, 8, 1, 1, 1, std::string("\x01\x02\x03\x04\x05\xff", 6), std::move(more)};
}
TiffFile floats(const std::vector<float>& values, std::vector<TiffFile::Tag> more = {}) {
  TiffFile file{static_cast<std::uint32_t>(values.size()), 1, 32, 1, 3, 1, {}, std::move(more)};
  for (const float value : values)
    file.pixels += test::little_endian(std::bit_cast<std::uint32_t>(value));
  return file;
}
std::vector<std::optional<double>> numbers(const std::string& file, int band = 1) {
  const auto info = inspect(file);
  if (!info) return {};
  const auto raster = decode_tiff_band(bytes_of(file), *info, band);
  if (!raster) return {};
  std::vector<std::optional<double>> values;
  for (std::size_t i = 0; i < raster->bits.size(); ++i)
    values.push_back(raster->valid[i] ? std::optional(decode_value(raster->type, raster->bits[i]))
                                      : std::nullopt);
  return values;
}

TEST(MapTiff, a_plain_one_has_numbers_and_colours_and_no_place) {
  const auto info = inspect(grey().write());
  ASSERT_TRUE(info) << info.error().detail;
  EXPECT_EQ(info->width, 3);
  EXPECT_EQ(info->height, 2);
  EXPECT_EQ(info->bands, 1);
  EXPECT_EQ(info->type, ValueType::u8);
  EXPECT_TRUE(info->has_numbers && info->has_colors && !info->is_rgb);
  EXPECT_FALSE(info->world || info->nodata);
  EXPECT_THAT(numbers(grey().write()), testing::ElementsAre(1, 2, 3, 4, 5, 255));
}

TEST(MapTiff, its_place_is_that_of_the_centre_of_the_first_pixel) {
  const auto scale = TiffFile::doubles(33550, {0.5, 0.25, 0});
  const auto tie = TiffFile::doubles(33922, {0, 0, 0, 100, 200, 0});
  const auto area = inspect(grey({scale, tie}).write());
  ASSERT_TRUE(area && area->world);
  EXPECT_EQ(area->world->x, 100.25);
  EXPECT_EQ(area->world->y, 199.875);
  EXPECT_EQ(area->world->x_per_column, 0.5);
  EXPECT_EQ(area->world->y_per_row, -0.25);
  // First a tie point in the middle of the image, then a tie point that refers to a pixel center.
  const auto middle =
      inspect(grey({scale, TiffFile::doubles(33922, {2, 1, 0, 101, 199.75, 0})}).write());
  ASSERT_TRUE(middle && middle->world);
  EXPECT_EQ(middle->world->x, 100.25);
  EXPECT_EQ(middle->world->y, 199.875);
  const auto keys = TiffFile::shorts(34735, {1, 1, 0, 2, 1025, 0, 1, 2, 3072, 0, 1, 25830});
  const auto point = inspect(grey({scale, tie, keys}).write());
  ASSERT_TRUE(point && point->world);
  EXPECT_EQ(point->world->x, 100);
  EXPECT_EQ(point->world->y, 200);
  EXPECT_EQ(point->crs, "EPSG:25830");
  // A matrix that rotates by 90°.
  const auto matrix = TiffFile::doubles(34264, {0, 2, 0, 10, 2, 0, 0, 20, 0, 0, 0, 0, 0, 0, 0, 1});
  const auto turned = inspect(grey({matrix}).write());
  ASSERT_TRUE(turned && turned->world);
  EXPECT_EQ(turned->world->x_per_row, 2);
  EXPECT_EQ(turned->world->y_per_column, 2);
  EXPECT_EQ(turned->world->x, 11);
  EXPECT_EQ(turned->world->y, 21);
}

TEST(MapTiff, longitude_and_latitude_are_told) {
  const auto info = inspect(grey({TiffFile::shorts(34735, {1, 1, 0, 1, 1024, 0, 1, 2})}).write());
  ASSERT_TRUE(info);
  EXPECT_TRUE(info->in_degrees);
}

TEST(MapTiff, nodata_and_what_is_no_number_have_no_value) {
  EXPECT_THAT(numbers(grey({TiffFile::texts(42113, "255")}).write()),
              testing::ElementsAre(1, 2, 3, 4, 5, std::nullopt));
  EXPECT_THAT(
      numbers(floats({0.5f, -9999, NAN, INFINITY}, {TiffFile::texts(42113, " -9999.0")}).write()),
      testing::ElementsAre(0.5, std::nullopt, std::nullopt, std::nullopt));
  EXPECT_THAT(
      numbers(
          floats({-3.40282347e+38f}, {TiffFile::texts(42113, "-3.4028234663852886e+38")}).write()),
      testing::ElementsAre(std::nullopt));
  EXPECT_THAT(numbers(grey({TiffFile::texts(42113, "none")}).write()), testing::Contains(255));
}

TEST(MapTiff, bands_of_every_width_are_read) {
  TiffFile two{2,
               1,
               16,
               2,
               2,
               1,
               test::little_endian(0xfffe, 2) + test::little_endian(7, 2) +
                   test::little_endian(300, 2) + test::little_endian(8, 2)};
  EXPECT_THAT(numbers(two.write(), 1), testing::ElementsAre(-2, 300));
  EXPECT_THAT(numbers(two.write(), 2), testing::ElementsAre(7, 8));
  EXPECT_TRUE(numbers(two.write(), 3).empty());
  TiffFile wide{1, 1, 64, 1, 3, 1, test::number(1.5)};
  EXPECT_THAT(numbers(wide.write()), testing::ElementsAre(1.5));
  TiffFile whole{1, 1, 32, 1, 1, 1, test::little_endian(4'000'000'001u)};
  EXPECT_THAT(numbers(whole.write()), testing::ElementsAre(4'000'000'001.0)) << "no digit is lost";
}

TEST(MapTiff, colours_keep_their_transparency) {
  TiffFile file{2, 1, 8, 4, 1, 2, std::string("\x80\x40\x20\xff\x80\x40\x20\x00", 8)};
  const auto info = inspect(file.write());
  ASSERT_TRUE(info) << info.error().detail;
  EXPECT_TRUE(info->is_rgb);
  const std::string bytes = file.write();
  const auto picture = decode_tiff_picture(bytes_of(bytes), *info);
  ASSERT_TRUE(picture) << picture.error().detail;
  EXPECT_THAT(picture->rgba, testing::ElementsAre(0x80, 0x40, 0x20, 0xff, 0, 0, 0, 0));
  const TiffFile rgb{2, 1, 8, 3, 1, 2, std::string(3, '\0') + "abc", {TiffFile::texts(42113, "0")}};
  const std::string rgb_bytes = rgb.write();
  const auto rgb_info = inspect(rgb_bytes);
  ASSERT_TRUE(rgb_info) << rgb_info.error().detail;
  const auto holed = decode_tiff_picture(bytes_of(rgb_bytes), *rgb_info);
  ASSERT_TRUE(holed) << holed.error().detail;
  EXPECT_EQ(holed->rgba[3], 0);
  EXPECT_EQ(holed->rgba[7], 255);
}

TEST(MapTiff, that_cannot_be_read_is_refused) {
  const std::string good = grey().write();
  for (const std::string& bad :
       {std::string(), std::string("II*"), good.substr(0, 20), std::string("II*\0\x08\0\0\0", 8)})
    EXPECT_FALSE(inspect(bad));
  EXPECT_FALSE(inspect_tiff(bytes_of(good), 2)) << "too wide";
  TiffFile odd = grey();
  odd.bits = 24;
  EXPECT_FALSE(inspect(odd.write()));
  EXPECT_FALSE(inspect(
      grey({TiffFile::doubles(33550, {0, 1, 0}), TiffFile::doubles(33922, {0, 0, 0, 1, 1, 0})})
          .write()))
      << "pixels without area";
  EXPECT_FALSE(inspect(
      grey({TiffFile::doubles(33550, {NAN, 1, 0}), TiffFile::doubles(33922, {0, 0, 0, 1, 1, 0})})
          .write()));
  TiffFile turned = grey();
  turned.orientation = 6;
  EXPECT_FALSE(inspect(turned.write()));
  // Tags with another type than the standard specifies are ignored.
  const auto strange = inspect(
      grey({TiffFile::shorts(33550, {1, 1, 0}), TiffFile::shorts(33922, {0, 0, 0, 1, 1, 0})})
          .write());
  ASSERT_TRUE(strange);
  EXPECT_FALSE(strange->world);
  const std::string cut = good.substr(0, good.size() - 3);
  if (const auto info = inspect(cut)) {
    EXPECT_FALSE(decode_tiff_band(bytes_of(cut), *info, 1));
    EXPECT_FALSE(decode_tiff_picture(bytes_of(cut), *info));
  }
}

TEST(MapTiff, damaged_anywhere_it_is_read_or_refused) {
  const std::string good =
      grey({TiffFile::doubles(33550, {1, 1, 0}), TiffFile::doubles(33922, {0, 0, 0, 1, 1, 0}),
            TiffFile::shorts(34735, {1, 1, 0, 1, 1025, 0, 1, 2}), TiffFile::texts(42113, "255")})
          .write();
  int refused = 0;
  for (const char change : {'\x00', '\x01', '\x7f', '\xff'})
    for (std::size_t i = 0; i < good.size(); ++i) {
      std::string damaged = good;
      damaged[i] = change;
      const auto info = inspect(damaged);
      refused += !info;
      if (!info) continue;
      for (int band = 1; band <= std::min(info->bands, 3); ++band)
        (void)decode_tiff_band(bytes_of(damaged), *info, band);
      (void)decode_tiff_picture(bytes_of(damaged), *info);
    }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace strata::query
