#pragma once

#include <cstdint>
#include <map>

#include "mesh/texel_graph.h"
#include "query/texel_selection.h"
#include "query/values.h"

namespace strata::query {

struct PieceCounts {
  std::uint64_t all = 0;
  std::map<std::uint32_t, std::uint64_t> of_key;  // by the bits of the value; empty for layers of fractions
};

// Areas of the surface that are connected and hold a value, the same one in layers of whole numbers; of texels in `within` (null:
// all). Seams of the atlas are no borders.
PieceCounts count_pieces(const LayerView& view, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
                         const TexelSelection* within);

}  // namespace strata::query
