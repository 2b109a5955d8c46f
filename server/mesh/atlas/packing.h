#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/atlas/outline.h"

namespace strata::mesh {

// Where a chart lies in the atlas.
struct Placement {
  int quarter_turns = 0;  // counterclockwise
  glm::ivec2 corner{0};   // lower left texel of its box
  glm::ivec2 box{1};      // its box before the quarter turns, whole texels

  // `p`: texels from the corner of the box; the outline begins at kNear (chart_mask.h). Whole
  // texels map to whole texels.
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
  // words of texels that finding it has read and written, the same on every machine
  std::uint64_t work = 0;
};

// What packing found at the first density that it tried.
struct PackingStart {
  double density = 0;
  // every chart is a single texel; the longest is as long as the atlas
  double least_density = 0, most_density = 0;
  // that the charts will fit at, within a few hundredths
  double expected_density = 0;
  std::vector<std::uint8_t> orders;     // of charts, those that pack best
  std::optional<Packing> packing = {};  // where they fit at the first density
};

// Lays all charts into a square of `side` texels at the densest scale found, so that `gap` whole
// texels stay between any two of them: each in turn at the lowest place where its exact shape fits,
// holes and bays included, in four turns. The work is near to proportional to the number of charts:
// where there are many, the search for a place begins at the places of the charts of like size
// before. Empty where even a single texel each is too much, or when cancelled. The result does not
// depend on the number of threads.
std::optional<Packing> pack_densely(std::span<const Outline> outlines, int side, int gap,
                                    const Progress& progress, int threads = 2);

// The same in two steps: the first takes a fraction of the time, and tells whether the second is
// worth it.
std::optional<PackingStart> begin_packing(std::span<const Outline> outlines, int side, int gap,
                                          const Progress& progress, int threads = 2);
std::optional<Packing> finish_packing(std::span<const Outline> outlines, int side, int gap,
                                      PackingStart start, const Progress& progress,
                                      int threads = 2);

// The same at one density; empty where it is too much.
std::optional<Packing> pack_at(std::span<const Outline> outlines, double texels_per_unit, int side,
                               int gap, const Progress& progress);

}  // namespace strata::mesh
