#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>

namespace strata::mesh {

// The texel centers that a triangle covers, as in OpenGL implementations. Vertices are snapped to
// 1/256 texel, and edge functions use integers. A center on an edge belongs to the triangle that
// has this edge on its left or lower side. The texels of two triangles that share an edge are
// therefore disjoint, and no texel between them is lost.
constexpr int kSubtexels = 256;

// A point of the texture in units of 1/256 texel. Resolution 16384 needs 22 bits, and the product
// of two coordinates fits in 64 bits.
using SnappedPoint = glm::ivec2;

inline SnappedPoint snap_to_subtexels(double x_texels, double y_texels) {
  return {static_cast<int>(std::lrint(x_texels * kSubtexels)),
          static_cast<int>(std::lrint(y_texels * kSubtexels))};
}

class CoverageRaster {
 public:
  // The triangle may have either orientation. A triangle without area covers nothing.
  CoverageRaster(SnappedPoint a, SnappedPoint b, SnappedPoint c) {
    twice_area_ = cross(a, b, c);
    if (twice_area_ == 0) return;
    if (twice_area_ < 0) std::swap(b, c);
    const std::array<SnappedPoint, 3> p{a, b, c};
    for (int k = 0; k < 3; ++k) {
      const auto from = p[k], to = p[(k + 1) % 3];
      const std::int64_t dx = to.x - from.x, dy = to.y - from.y;
      const bool owns_its_points = dy < 0 || (dy == 0 && dx > 0);
      Edge& edge = edges_[k];
      edge.step_x = -dy * kSubtexels;
      edge.step_y = dx * kSubtexels;
      // The value at the center of texel (0, 0). Values inside are ≥ 0.
      edge.at_origin = dx * (kSubtexels / 2 - from.y) - dy * (kSubtexels / 2 - from.x) -
                       (owns_its_points ? 0 : 1);
    }
    x_first_ = first_centre(std::min({a.x, b.x, c.x}));
    x_last_ = last_centre(std::max({a.x, b.x, c.x}));
    y_first_ = first_centre(std::min({a.y, b.y, c.y}));
    y_last_ = last_centre(std::max({a.y, b.y, c.y}));
  }

  std::int64_t twice_area() const { return twice_area_; }  // in (1/256 texel)², signed

  // Calls visit(y, x_begin, x_end) for each row with covered texels in the window [x_low, x_high) ×
  // [y_low, y_high), upward. Stops when visit returns false. Returns true if it reached the end.
  template <class Visit>
  bool for_each_span(int x_low, int x_high, int y_low, int y_high, Visit&& visit) const {
    if (twice_area_ == 0) return true;
    const int x0 = std::max(x_first_, x_low), x1 = std::min(x_last_, x_high - 1);
    const int y0 = std::max(y_first_, y_low), y1 = std::min(y_last_, y_high - 1);
    if (x0 > x1) return true;
    for (int y = y0; y <= y1; ++y) {
      int begin = x0, end = x1 + 1;
      for (const Edge& edge : edges_) narrow(edge, y, begin, end);
      if (begin < end && !visit(y, begin, end)) return false;
    }
    return true;
  }

 private:
  struct Edge {
    std::int64_t step_x = 0, step_y = 0, at_origin = 0;
  };

  static std::int64_t cross(SnappedPoint a, SnappedPoint b, SnappedPoint c) {
    return std::int64_t{b.x - a.x} * (c.y - a.y) - std::int64_t{b.y - a.y} * (c.x - a.x);
  }
  static int first_centre(int low) { return (low - kSubtexels / 2 + kSubtexels - 1) >> 8; }
  static int last_centre(int high) { return (high - kSubtexels / 2) >> 8; }

  // Narrows [begin, end) to the texels of row y on the inner side of the edge.
  static void narrow(const Edge& edge, int y, int& begin, int& end) {
    if (begin >= end) return;
    std::int64_t value = edge.at_origin + edge.step_y * y + edge.step_x * begin;
    if (edge.step_x > 0) {
      if (value >= 0) return;
      if (end - begin > 8) {
        const std::int64_t skip = (-value + edge.step_x - 1) / edge.step_x;
        begin = static_cast<int>(std::min<std::int64_t>(end, begin + skip));
        return;
      }
      for (; begin < end && value < 0; ++begin) value += edge.step_x;
    } else if (edge.step_x == 0) {
      if (value < 0) end = begin;
    } else {
      if (value < 0) {
        end = begin;
      } else if (end - begin > 8) {
        end = static_cast<int>(std::min<std::int64_t>(end, begin + value / -edge.step_x + 1));
      } else {
        int x = begin;
        for (; x < end && value >= 0; ++x) value += edge.step_x;
        end = x;
      }
    }
  }

  std::int64_t twice_area_ = 0;
  std::array<Edge, 3> edges_{};
  int x_first_ = 0, x_last_ = -1, y_first_ = 0, y_last_ = -1;
};

}  // namespace strata::mesh
