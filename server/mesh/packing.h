#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/charts.h"

namespace strata::mesh {

// The rim of a chart in its plane, turned so that its bounding box has the least area, lower left corner at 0.
struct Outline {
  std::vector<glm::vec2> segments;  // two points each, any order
  glm::vec2 size{0};                // of the box, in units of the mesh
  float cosine = 1, sine = 0;       // of the turn
  glm::vec2 low{0};                 // the box's corner, after the turn

  glm::vec2 from_chart(glm::vec2 p) const {
    return glm::vec2(cosine * p.x - sine * p.y, sine * p.x + cosine * p.y) - low;
  }
};
std::vector<Outline> make_outlines(const ChartSurface& surface, std::span<const Chart> charts);

// Where a chart lies in the atlas.
struct Placement {
  int quarter_turns = 0;  // counterclockwise
  glm::ivec2 corner{0};   // lower left texel of its box
  glm::ivec2 box{1};      // its box before the quarter turns, whole texels

  // `p`: texels from the outline's corner. Whole texels map to whole texels.
  glm::dvec2 to_atlas(glm::dvec2 p) const {
    const glm::dvec2 size(box);
    switch (quarter_turns) {
      case 1: p = {size.y - p.y, p.x}; break;
      case 2: p = size - p; break;
      case 3: p = {p.y, size.x - p.x}; break;
      default: break;
    }
    return p + glm::dvec2(corner);
  }
};

struct Packing {
  double texels_per_unit = 0;
  std::vector<Placement> placements;
};

// Lays all charts into a square of `side` texels at the densest scale, within about 1 %, searched from `first_guess`,
// so that `gap` whole texels stay between any two of them: by the skyline method with four turns. Empty where even a
// single texel each is too much, or when cancelled.
std::optional<Packing> pack_densely(std::span<const Outline> outlines, double first_guess, int side, int gap,
                                    const Progress& progress);

}  // namespace strata::mesh
