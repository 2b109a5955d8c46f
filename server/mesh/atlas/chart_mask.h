#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "mesh/atlas/outline.h"

namespace strata::mesh {

// The distance, in texels, between the border of a chart's box and the chart. A chart also touches
// the texels within this distance. Rounding, and the precision of UVs and of a GPU, can move a
// point, but less than this. Texels outside a mask therefore stay empty in every quarter turn.
constexpr double kNear = 1.0 / 256;

// The texels that a chart touches, as runs in each row.
struct ChartMask {
  struct Run {
    std::int16_t begin, end;
    bool operator==(const Run&) const = default;
  };
  int width = 0, height = 0;
  std::vector<std::uint32_t> first_run;  // one entry for each row and one for the end
  std::vector<Run> runs;                 // in a row: disjoint, from left to right

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

// The masks of a chart at one density in its four quarter turns (counterclockwise).
struct ChartShape {
  glm::ivec2 box{1};  // in whole texels, before the turns; the outline begins at kNear
  std::array<ChartMask, 4> turned;
};
ChartShape make_shape(const Outline& outline, double texels_per_unit);

}  // namespace strata::mesh
