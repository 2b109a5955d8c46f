#pragma once

#include <cstdint>
#include <map>

#include "mesh/texels/texel_graph.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::query {

struct PieceCounts {
  std::uint64_t all = 0;
  std::map<std::uint32_t, std::uint64_t> of_class;  // by ValueClasses::of
};

// Areas of the surface that are connected and hold values of one class; of texels in `within`
// (null: all). Seams of the atlas are no borders.
PieceCounts count_pieces(const LayerView& view, const mesh::SurfaceMap& map,
                         const mesh::TexelGraph& graph, const TexelSelection* within,
                         const ValueClasses& classes);

}  // namespace strata::query
