#include "query/maps/color_keys.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace strata::query {
namespace {

// Returns paper with a red area, a blue area and a thin green line, with the noise of a scan.
Picture scanned_map() {
  Picture picture{200, 100, {}};
  std::mt19937 random(3);
  std::uniform_int_distribution<int> noise(-6, 6);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      Rgba color{240, 235, 220, 255};
      if (x >= 20 && x < 80 && y >= 20 && y < 80) color = {190, 40, 40, 255};
      if (x >= 120 && x < 160 && y >= 20 && y < 80) color = {40, 60, 180, 255};
      if (y == 90 && x > 10 && x < 190) color = {30, 140, 60, 255};
      for (int c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::clamp(color[c] + noise(random), 0, 255));
      picture.rgba.insert(picture.rgba.end(), color.begin(), color.end());
    }
  return picture;
}

TEST(ColorKeys, a_pixel_has_the_value_of_the_nearest_colour_within_the_tolerance) {
  const auto keys = parse_color_keys(R"({"#ff0000": 1, "#0000FFff": 2.5, "#ff8000": 7})", "colors");
  ASSERT_TRUE(keys) << keys.error().detail;
  const ColorKeys by_color(*keys, 12);
  const auto value = [&](std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    const std::uint8_t rgb[] = {r, g, b};
    return by_color.value_of(rgb);
  };
  EXPECT_EQ(value(255, 0, 0), 1);
  EXPECT_EQ(value(245, 8, 6), 1);
  EXPECT_EQ(value(4, 4, 250), 2.5);
  EXPECT_EQ(value(250, 124, 10), 7);
  EXPECT_EQ(value(255, 255, 255), std::nullopt);
  EXPECT_EQ(value(0, 0, 0), std::nullopt);
  EXPECT_EQ(value(128, 0, 0), std::nullopt);
}

TEST(ColorKeys, that_are_none_are_refused) {
  for (const char* text : {"", "{}", "[]", "{\"#ff0000\":\"1\"}", "{\"red\":1}", "{\"#ff00\":1}",
                           "{\"#gg0000\":1}", "7"}) {
    const auto keys = parse_color_keys(text, "colors");
    ASSERT_FALSE(keys) << text;
    EXPECT_EQ(keys.error().field, "colors");
    EXPECT_EQ(keys.error().code, ErrorCode::invalid);
  }
}

TEST(ColorKeys, the_few_colours_of_a_scanned_map_are_found_and_its_paper_told_apart) {
  const auto found = find_colors(scanned_map(), kUsualTolerance);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_TRUE(found[0].is_background);
  const auto near = [](const Rgba& color, int r, int g, int b) {
    return std::abs(color[0] - r) < 4 && std::abs(color[1] - g) < 4 && std::abs(color[2] - b) < 4;
  };
  EXPECT_TRUE(near(found[0].color, 240, 235, 220));
  EXPECT_TRUE(near(found[1].color, 190, 40, 40));
  EXPECT_TRUE(near(found[2].color, 40, 60, 180));
  EXPECT_TRUE(near(found[3].color, 30, 140, 60));
  EXPECT_NEAR(found[1].share, 3600.0 / 20000, 1e-3);
  EXPECT_FALSE(found[1].is_background || found[2].is_background || found[3].is_background);
}

TEST(ColorKeys, a_picture_of_nothing_has_no_colours) {
  EXPECT_TRUE(find_colors({2, 1, {1, 2, 3, 0, 4, 5, 6, 100}}, 12).empty());
  const auto one = find_colors({1, 1, {9, 8, 7, 255}}, 12);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].color, (Rgba{9, 8, 7, 255}));
}

}  // namespace
}  // namespace strata::query
