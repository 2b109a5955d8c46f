#pragma once

#include <cstdint>
#include <map>

#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::mesh {
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

struct PieceCounts {
  std::uint64_t all = 0;
  std::map<std::uint32_t, std::uint64_t> of_class;  // by ValueClasses::of
};

// Counts the connected areas of the surface with values of one class. `within` restricts the
// texels; null means all texels. Seams of the atlas do not separate areas.
PieceCounts count_pieces(const LayerView& view, const mesh::SurfaceMap& map,
                         const mesh::TexelGraph& graph, const TexelSelection* within,
                         const ValueClasses& classes);

}  // namespace strata::query
