#include "media/shape_texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/shapes.h"

namespace strata {
namespace {

// Returns a gray image with the same alpha in every pixel.
Picture grey(int width, int height, const std::function<int(int, int)>& level, int alpha = 255) {
  Picture picture{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int channel : {level(x, y), level(x, y), level(x, y), alpha})
        picture.rgba.push_back(static_cast<std::uint8_t>(channel));
  return picture;
}

int count(const ShapeBits& bits) {
  int sum = 0;
  for (const auto word : bits) sum += std::popcount(word);
  return sum;
}

TEST(ShapeTexture, a_picture_of_the_rasters_size_is_taken_cell_by_cell) {
  std::mt19937 random(3);
  std::vector<int> levels;
  for (int i = 0; i < kShapeSide * kShapeSide; ++i)
    levels.push_back(static_cast<int>(random() % 256));
  const auto bits =
      shape_of(grey(256, 256, [&](int x, int y) { return levels[std::size_t(y * 256 + x)]; }), {});
  ASSERT_TRUE(bits);
  const ShapeTexture shape(*bits);
  for (int y = 0; y < kShapeSide; ++y)
    for (int x = 0; x < kShapeSide; ++x)
      ASSERT_EQ(shape.is_set(x, y), levels[std::size_t(y * 256 + x)] >= 128);
}

TEST(ShapeTexture, larger_and_smaller_pictures_are_scaled_by_the_mean_of_what_a_cell_covers) {
  const auto half = [](int size) {
    return grey(size, size, [size](int x, int) { return x * 2 < size ? 255 : 0; });
  };
  const ShapeBits expected = test::shape_bits([](double x, double) { return x < 0; });
  for (const int size : {2, 16, 200, 256, 1000, 2048})
    EXPECT_EQ(shape_of(half(size), {}).value(), expected) << size;
  // Stripes finer than a cell set no cell if less than half is light, and otherwise every cell.
  const auto stripes = [](int light) {
    return grey(1024, 1024, [light](int x, int) { return x % 4 < light ? 255 : 0; });
  };
  EXPECT_EQ(shape_of(stripes(1), {}).error().code, ErrorCode::invalid);
  EXPECT_EQ(count(shape_of(stripes(3), {}).value()), kShapeSide * kShapeSide);
}

TEST(ShapeTexture, an_oblong_picture_lies_in_the_middle_of_the_square) {
  const auto white = [](int, int) { return 255; };
  EXPECT_EQ(shape_of(grey(100, 50, white), {}).value(),
            test::shape_bits([](double, double y) { return std::abs(y) < 0.5; }));
  EXPECT_EQ(shape_of(grey(50, 100, white), {}).value(),
            test::shape_bits([](double x, double) { return std::abs(x) < 0.5; }));
}

TEST(ShapeTexture, the_tool_is_what_is_opaque_or_else_what_is_light_unless_it_is_said) {
  const auto left_white = [](int x, int) { return x < 8 ? 255 : 0; };
  const auto left = test::shape_bits([](double x, double) { return x < 0; });
  const auto right = test::shape_bits([](double x, double) { return x > 0; });
  EXPECT_EQ(shape_of(grey(16, 16, left_white), {}).value(), left);
  EXPECT_EQ(shape_of(grey(16, 16, left_white), ShapePart::dark).value(), right);
  EXPECT_EQ(count(shape_of(grey(16, 16, left_white), ShapePart::opaque).value()),
            kShapeSide * kShapeSide);
  auto black_left = grey(16, 16, [](int, int) { return 0; });
  for (std::size_t i = 0; i < 256; ++i)
    if (i % 16 >= 8) black_left.rgba[4 * i + 3] = 0;
  EXPECT_EQ(shape_of(black_left, {}).value(), left);
  EXPECT_EQ(shape_of(black_left, ShapePart::dark).value(), left)
      << "what is transparent is not dark";
  EXPECT_EQ(shape_of(black_left, ShapePart::light).error().code, ErrorCode::invalid);
}

TEST(ShapeTexture, a_picture_with_nothing_of_the_tool_is_refused_with_what_to_do) {
  const auto refused = shape_of(grey(64, 64, [](int, int) { return 20; }), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::invalid);
  EXPECT_NE(refused.error().detail.find("part=dark"), std::string::npos);
}

TEST(ShapeTexture, its_own_picture_gives_the_same_shape_again) {
  const auto bits = test::shape_bits(test::in_flag);
  EXPECT_EQ(shape_of(picture_of(bits), {}).value(), bits);
}

TEST(ShapeTexture, distances_are_those_of_a_chess_king) {
  const ShapeBits bits = test::shape_bits(test::in_dots);
  const ShapeTexture shape(bits);
  std::vector<std::pair<int, int>> set;
  for (int y = 0; y < kShapeSide; ++y)
    for (int x = 0; x < kShapeSide; ++x)
      if (shape.is_set(x, y)) set.emplace_back(x, y);
  for (int y = 0; y < kShapeSide; y += 5) {
    for (int x = 0; x < kShapeSide; x += 3) {
      int nearest = 255;
      for (const auto& [sx, sy] : set)
        nearest = std::min(nearest, std::max(std::abs(sx - x), std::abs(sy - y)));
      ASSERT_EQ(shape.distances()[std::size_t(y * kShapeSide + x)], nearest) << x << ", " << y;
    }
  }
}

TEST(ShapeTexture, the_inner_disc_lies_in_the_tool) {
  EXPECT_EQ(ShapeTexture(test::shape_bits(test::in_ring)).inner_radius(), 0);
  EXPECT_EQ(ShapeTexture(test::shape_bits([](double, double) { return true; })).inner_radius(), 1);
  const double inner = ShapeTexture(test::shape_bits([](double x, double y) {
                         return std::hypot(x, y) < 0.5;
                       })).inner_radius();
  EXPECT_GT(inner, 0.49);
  EXPECT_LT(inner, 0.5);
}

}  // namespace
}  // namespace strata
