#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/outline.h"

namespace strata::mesh {

// Texels between the rim of a chart's box and the chart: a texel counts as touched by everything
// that is as near. Rounding, the steps of UVs and a GPU's grid move a point by less, so texels
// outside a mask stay empty in every quarter turn.
constexpr double kNear = 1.0 / 256;

// The texels that a chart touches, row by row as runs.
struct ChartMask {
  struct Run {
    std::int16_t begin, end;
    bool operator==(const Run&) const = default;
  };
  int width = 0, height = 0;
  std::vector<std::uint32_t> first_run;  // of each row, and the end
  std::vector<Run> runs;                 // of a row: disjoint, from left to right

  std::span<const Run> row(int y) const {
    return {runs.data() + first_run[y], runs.data() + first_run[y + 1]};
  }
  std::int64_t area() const {
    std::int64_t sum = 0;
    for (const Run& run : runs) sum += run.end - run.begin;
    return sum;
  }
  bool operator==(const ChartMask&) const = default;
};

// A chart at one density in its four quarter turns, counterclockwise.
struct ChartShape {
  glm::ivec2 box{1};  // whole texels, before the turns; the outline begins at kNear
  std::array<ChartMask, 4> turned;
};
ChartShape make_shape(const Outline& outline, double texels_per_unit);

}  // namespace strata::mesh
