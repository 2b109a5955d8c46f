#pragma once

#include <map>
#include <span>

#include "domain/layers/tile.h"
#include "domain/layers/value_type.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {

// A value for the texels around a point on the surface.
struct PointSplat {
  std::uint32_t texel = 0;  // the surface texel at the point (numbered as in TexelGraph)
  glm::vec3 position{0};    // position of the point in model space
  std::uint32_t bits = 0;   // the value, in the type of the layer
};

constexpr std::uint64_t kMaxDabTexels = 50'000'000;  // limit for all splats of one edit

// Each splat covers the texels within `radius` (model units, Euclidean distance) of its position.
// Only texels connected to the splat within that distance are covered, not the other side of a thin
// wall. Where splats overlap, the nearest splat is used, or the first of several at the same
// distance. The result is the content to write: the valid texels of each tile, gutter included.
// Returns an `invalid` error if the splats reach more than kMaxDabTexels.
Result<std::map<TileAddress, TileData>> paint_point_splats(const mesh::SurfaceMap& map,
                                                           const mesh::TexelGraph& graph,
                                                           std::span<const PointSplat> point_splats,
                                                           float radius, ValueType type);

}  // namespace strata::query
