#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "figure/outlines/border_arcs.h"

namespace strata::figure {

// A border as a smooth line. Coordinates are cells. A ring is closed and does not repeat its first
// point. Other lines begin and end exactly at the nodes of the border.
struct SmoothArc {
  std::vector<glm::dvec2> points;
  // The points of the chain whose positions determine a segment, by segment. The segment `i` ends
  // at the point i + 1, or in a ring perhaps at the point 0. `last` may be below `first` in a ring.
  struct Range {
    std::uint32_t first = 0, last = 0;
  };
  std::vector<Range> ranges;
};

// The shares of the tolerance that a point of a chain may use: all of it, a half, a quarter, or
// nothing.
inline constexpr std::uint8_t kExact = 3;

// Removes the stairs of a border. Each point of the result is at most `tolerance` (in cells) from
// the chain, multiplied by the share of its level. With kExact at all points, the result is the
// chain. `levels` has one element for each point of the chain.
//
// The steps: a Gaussian filter whose shrinkage is corrected once, the algorithm of Douglas and
// Peucker, a least-squares line through the points of each side, and quadratic curves around the
// corners. Each step has its share of the tolerance.
SmoothArc smooth_arc(const BorderArc& arc, const std::vector<std::uint8_t>& levels,
                     double tolerance);

}  // namespace strata::figure
