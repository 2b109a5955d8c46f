#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "media/shape_texture.h"

namespace strata::test {

// Returns the shape of the points where `inside` is true. Its arguments x and y are −1…1, with y
// up.
inline ShapeBits shape_bits(const std::function<bool(double, double)>& inside) {
  ShapeBits bits{};
  for (int y = 0; y < kShapeSide; ++y)
    for (int x = 0; x < kShapeSide; ++x)
      if (inside((x + 0.5) * 2 / kShapeSide - 1, 1 - (y + 0.5) * 2 / kShapeSide))
        bits[std::size_t(y * kShapeSide + x) / 64] |= std::uint64_t{1} << (x % 64);
  return bits;
}
inline std::shared_ptr<const ShapeTexture> shape(
    const std::function<bool(double, double)>& inside) {
  return std::make_shared<const ShapeTexture>(shape_bits(inside));
}

// Shapes that differ from their mirror images.
inline bool in_flag(double x, double y) {
  return (x < -0.6 && x > -0.8) || (x > -0.8 && y > x * 0.5 + 0.1 && y < 0.9);
}
inline bool in_ring(double x, double y) {
  return std::abs(std::hypot(x, y) - 0.8) < 0.12 && !(x > 0 && y > 0 && x > y);
}
inline bool in_bar(double x, double y) { return std::abs(y - 0.3) < 0.012 && x < 0.7; }
inline bool in_dots(double x, double y) {
  return std::hypot(x - 0.7, y - 0.6) < 0.02 || std::hypot(x + 0.5, y - 0.1) < 0.05 ||
         std::hypot(x, y + 0.9) < 0.08;
}

}  // namespace strata::test
