#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "render/view/depth_copy.h"

namespace strata::render {
namespace {

TEST(DepthCopy, slopes_and_cells_are_those_of_their_definition_at_any_size) {
  std::mt19937 random(3);
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {33, 2}, {16, 16}, {70, 49}}) {
    std::vector<float> depth(std::size_t(width * height));
    for (float& d : depth) d = std::uniform_real_distribution(0.0f, 1.0f)(random);
    const DepthCopy copy = make_depth_copy(depth, width, height, 3);
    EXPECT_EQ(copy.depth, depth);
    const auto at = [&, w = width, h = height](int x, int y) {
      return depth[std::size_t(std::clamp(y, 0, h - 1) * w + std::clamp(x, 0, w - 1))];
    };
    std::vector<float> deepest(std::size_t((width + 15) / 16 * ((height + 15) / 16)), 0.0f);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float here = at(x, y);
        const float slope = std::min(std::abs(here - at(x - 1, y)), std::abs(at(x + 1, y) - here)) +
                            std::min(std::abs(here - at(x, y - 1)), std::abs(at(x, y + 1) - here));
        ASSERT_EQ(copy.slope[std::size_t(y * width + x)], slope)
            << width << " x " << height << ", " << x << ", " << y;
        float& cell = deepest[std::size_t(y / 16 * ((width + 15) / 16) + x / 16)];
        cell = std::max(cell, here);
      }
    EXPECT_EQ(copy.grid, deepest);
  }
}

}  // namespace
}  // namespace strata::render
