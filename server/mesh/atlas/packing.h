#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/atlas/outline.h"

namespace strata::mesh {

// The position of a chart in the atlas.
struct Placement {
  int quarter_turns = 0;  // counterclockwise
  glm::ivec2 corner{0};   // lower left texel of its box
  glm::ivec2 box{1};      // its box in whole texels before the quarter turns

  // `p` is in texels from the corner of the box. The outline begins at kNear (chart_mask.h). Maps
  // whole texels to whole texels.
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
  // words of texels that the search read and wrote, the same on every machine
  std::uint64_t work = 0;
};

// The result of packing at the first density tried.
struct PackingStart {
  double density = 0;
  // At the lowest density every chart is a single texel. At the highest density the longest chart
  // is as long as the atlas.
  double least_density = 0, most_density = 0;
  // the density at which the charts will fit, with an error of a few hundredths
  double expected_density = 0;
  std::vector<std::uint8_t> orders;     // the orders of charts that pack best
  std::optional<Packing> packing = {};  // if the charts fit at the first density
};

// Packs all charts into a square of `side` texels at the highest density found, with at least `gap`
// whole texels between any two charts. Each chart gets the lowest position where its exact shape
// fits in one of four turns. Positions in holes and bays are included. The work is almost
// proportional to the number of charts. With many charts, the search for a position begins at the
// positions of earlier charts of similar size. The result is empty when cancelled, or if even one
// texel per chart is too much. It does not depend on the number of threads.
std::optional<Packing> pack_densely(std::span<const Outline> outlines, int side, int gap,
                                    const Progress& progress, int threads = 2);

// These two functions pack the charts in two steps. The first step takes a fraction of the time,
// and its result shows whether the second step is useful.
std::optional<PackingStart> begin_packing(std::span<const Outline> outlines, int side, int gap,
                                          const Progress& progress, int threads = 2);
std::optional<Packing> finish_packing(std::span<const Outline> outlines, int side, int gap,
                                      PackingStart start, const Progress& progress,
                                      int threads = 2);

// Packs the charts at one density. The result is empty if the charts do not fit.
std::optional<Packing> pack_at(std::span<const Outline> outlines, double texels_per_unit, int side,
                               int gap, const Progress& progress);

}  // namespace strata::mesh
