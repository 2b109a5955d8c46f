#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"

namespace strata::query {

// The selection of surface that looks like the surface at one place ("magic wand"), or of the part
// of it that a brush passes ("smart brush").
//
// A texel is similar if its value differs from the value at `start` by at most `tolerance`. It is
// also similar if the mean over the texel and its neighbors does (3 × 3 texels, fewer at open edges
// and across seams). The mean closes the holes that noise makes. The value of the texel itself
// keeps the edges of regions, where the mean contains both sides. The value at `start` is the mean
// there. Texels without a value are similar to each other only.
struct Similarity {
  struct Place {
    std::uint32_t texel = 0;  // of the surface, numbered as in TexelGraph
    glm::vec3 position{0};    // in model space
  };
  std::uint32_t start = 0;  // the texel whose value is compared
  // The selection lies around these places: one for a wand, the places under its path for a brush.
  std::vector<Place> around{};
  // in model units, Euclidean distance from the nearest place
  float radius = std::numeric_limits<float>::infinity();
  double tolerance = 0;
  // true: only texels that are connected to a place through similar texels within the radius.
  // false: all similar texels that are connected to a place within the radius; without a limit, all
  // similar texels of the surface.
  bool contiguous = true;
};

// The following functions return surface texels without gutter. The result does not depend on the
// number of threads, and not on seams of the atlas except for the means. They take about a second
// for three million visited texels on one core.

// `colors` has 64 colors per slot, as made by texel_appearance.h. The tolerance is a distance in
// CIELAB (sampling/cielab.h). Colors are averaged as light.
TexelSelection select_similar_colors(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     std::span<const std::uint32_t> colors,
                                     const Similarity& similarity, int threads = 1);

// `normals` has 64 normals per slot, as made by texel_appearance.h. The tolerance is an angle in
// degrees.
TexelSelection select_similar_normals(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                      std::span<const std::uint32_t> normals,
                                      const Similarity& similarity, int threads = 1);

// The layer can have another resolution than the map. The tolerance is a difference of values.
// Keys, and values of a categorical palette, are not averaged.
TexelSelection select_similar_values(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                                     const LayerView& view, const Similarity& similarity,
                                     int threads = 1);

}  // namespace strata::query
