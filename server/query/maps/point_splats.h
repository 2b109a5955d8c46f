#pragma once

#include <map>
#include <span>

#include "domain/layers/tile.h"
#include "domain/layers/value_type.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {

// A value for the surroundings of a point of the surface.
struct PointSplat {
  std::uint32_t texel = 0;  // the surface texel at the point (numbered as in TexelGraph)
  glm::vec3 position{0};    // of the point, model space
  std::uint32_t bits = 0;   // of the layer's type
};

constexpr std::uint64_t kMaxDabTexels = 50'000'000;  // limit for all dabs of one edit together

// Each dab covers the texels within `radius` (model units, Euclidean) of its position that are
// connected with it across the surface within that distance: this excludes the other side of a thin
// wall. Where dabs overlap the nearest one counts, among equals the first. The result is the
// content to write: each tile's valid texels, gutter included. Refused (invalid): dabs so large and
// numerous that they reach more than kMaxDabTexels.
Result<std::map<TileAddress, TileData>> paint_point_splats(const mesh::SurfaceMap& map,
                                                           const mesh::TexelGraph& graph,
                                                           std::span<const PointSplat> point_splats,
                                                           float radius, ValueType type);

}  // namespace strata::query
