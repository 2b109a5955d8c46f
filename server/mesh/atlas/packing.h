#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/progress.h"
#include "mesh/atlas/outline.h"

namespace strata::mesh {

// Position of a chart in the atlas.
struct Placement {
  int quarter_turns = 0;  // counterclockwise
  glm::ivec2 corner{0};   // lower left texel of its box
  glm::ivec2 box{1};      // its box before the quarter turns, whole texels

  // `p`: texels from the corner of the box; the outline begins at kNear (chart_mask.h). Maps whole
  // texels to whole texels.
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
  // words of texels read and written by the search, the same on every machine
  std::uint64_t work = 0;
};

// The result of packing at the first density tried.
struct PackingStart {
  double density = 0;
  // at the least density every chart is a single texel; at the most the longest is as long as the
  // atlas
  double least_density = 0, most_density = 0;
  // the density at which the charts will fit, within a few hundredths
  double expected_density = 0;
  std::vector<std::uint8_t> orders;     // the orders of charts that pack best
  std::optional<Packing> packing = {};  // if the charts fit at the first density
};

// Packs all charts into a square of `side` texels at the densest scale found, with at least `gap`
// whole texels between any two. Each chart in turn gets the lowest place where its exact shape
// fits, holes and bays included, in four turns. The work is almost proportional to the number of
// charts: with many charts, the search for a place begins at the places of earlier charts of
// similar size. Empty where even a single texel for each chart is too much, or when cancelled. The
// result does not depend on the number of threads.
std::optional<Packing> pack_densely(std::span<const Outline> outlines, int side, int gap,
                                    const Progress& progress, int threads = 2);

// The same in two steps. The first takes a fraction of the time, and its result shows whether the
// second is useful.
std::optional<PackingStart> begin_packing(std::span<const Outline> outlines, int side, int gap,
                                          const Progress& progress, int threads = 2);
std::optional<Packing> finish_packing(std::span<const Outline> outlines, int side, int gap,
                                      PackingStart start, const Progress& progress,
                                      int threads = 2);

// The same at one density; empty where the charts do not fit.
std::optional<Packing> pack_at(std::span<const Outline> outlines, double texels_per_unit, int side,
                               int gap, const Progress& progress);

}  // namespace strata::mesh
