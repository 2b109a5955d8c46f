#include "query/sampling/lightness_tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "query/regions/surface_values.h"
#include "support/cut_sheet.h"

namespace strata::query {
namespace {

// The definition of L* (CIE 015:2018) for a gray sRGB code (IEC 61966-2-1).
double lightness_of_gray(int code) {
  const double c = code / 255.0;
  const double y = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  return y > 216.0 / 24389 ? 116 * std::cbrt(y) - 16 : y * 24389 / 27;
}

std::uint32_t gray(int code, std::uint32_t alpha = 255) {
  return static_cast<std::uint32_t>(code) * 0x010101u | alpha << 24;
}

class LightnessTiles : public testing::Test {
 protected:
  // Returns the values with the color of each surface texel.
  Result<SurfaceValues> values(const std::function<std::uint32_t(std::uint32_t)>& color_of,
                               ValueType type = ValueType::f32) {
    TexelAppearance colors(sheet_.map.block_of_slot.size() * 64, gray(9));
    test::for_each_surface_texel(sheet_.map,
                                 [&](std::uint32_t texel) { colors[texel] = color_of(texel); });
    const auto tiles = STRATA_TRY(lightness_tiles(colors, sheet_.map, type, progress_));
    return read_surface_values(tiles, type, sheet_.map);
  }

  test::Surface sheet_ = test::cut_sheet({{96}, {64}});
  Progress progress_;
};

TEST_F(LightnessTiles, have_the_lightness_of_each_color) {
  const auto code_of = [](std::uint32_t texel) { return static_cast<int>(texel * 7 % 256); };
  const auto measured = values([&](std::uint32_t texel) { return gray(code_of(texel)); });
  ASSERT_TRUE(measured);
  test::for_each_surface_texel(sheet_.map, [&](std::uint32_t texel) {
    ASSERT_TRUE(measured->of(texel).valid);
    ASSERT_NEAR(decode_value(ValueType::f32, measured->of(texel).bits),
                lightness_of_gray(code_of(texel)), 0.01)
        << code_of(texel);
  });
}

TEST_F(LightnessTiles, of_red_and_of_whole_numbers) {
  const auto red = values([](std::uint32_t) { return 0xff0000ffu; });
  const auto whole = values([](std::uint32_t) { return 0xff0000ffu; }, ValueType::u8);
  ASSERT_TRUE(red && whole);
  test::for_each_surface_texel(sheet_.map, [&](std::uint32_t texel) {
    ASSERT_NEAR(decode_value(ValueType::f32, red->of(texel).bits), 53.24, 0.01);
    ASSERT_EQ(decode_value(ValueType::u8, whole->of(texel).bits), 53);
  });
}

TEST_F(LightnessTiles, have_no_value_where_the_color_is_transparent) {
  const auto alpha_of = [](std::uint32_t texel) { return 126 + texel % 4; };
  const auto measured = values([&](std::uint32_t texel) { return gray(255, alpha_of(texel)); });
  ASSERT_TRUE(measured);
  test::for_each_surface_texel(sheet_.map, [&](std::uint32_t texel) {
    ASSERT_EQ(measured->of(texel).valid, alpha_of(texel) >= 128);
  });
}

TEST_F(LightnessTiles, fail_when_cancelled) {
  progress_.cancel();
  const auto measured = values([](std::uint32_t) { return gray(1); });
  ASSERT_FALSE(measured);
  EXPECT_EQ(measured.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace strata::query
