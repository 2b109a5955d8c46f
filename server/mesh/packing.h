#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/outline.h"

namespace strata::mesh {

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

// Lays all charts into a square of `side` texels at the densest scale found, so that `gap` whole texels stay between any
// two of them: each in turn at the lowest place where its exact shape fits, holes and bays included, in four turns. Empty where
// even a single texel each is too much, or when cancelled. The result does not depend on the number of threads.
std::optional<Packing> pack_densely(std::span<const Outline> outlines, int side, int gap, const Progress& progress,
                                    int threads = 2);

// The same at one density; empty where it is too much.
std::optional<Packing> pack_at(std::span<const Outline> outlines, double texels_per_unit, int side, int gap,
                               const Progress& progress);

}  // namespace strata::mesh
