#pragma once

#include <map>
#include <span>

#include "domain/layers/tile.h"
#include "domain/layers/value_type.h"
#include "mesh/texels/texel_graph.h"

namespace strata::query {

// A value around a place of the surface.
struct PointSplat {
  std::uint32_t texel = 0;  // the surface texel at the place (numbered as in TexelGraph)
  glm::vec3 position{0};    // the place, model space
  std::uint32_t bits = 0;   // of the layer's type
};

constexpr std::uint64_t kMaxDabTexels = 50'000'000;  // that all dabs of one edit may reach together

// Each dab covers what lies within `radius` (model units, straight) of its place and is connected
// with it across the surface within that distance: the other side of a thin wall is not. Where dabs
// overlap the nearest one counts, among equals the first. The result holds what is written: each
// tile's valid texels, gutter included. Refused (invalid): dabs so large and many that they reach
// more than kMaxDabTexels.
Result<std::map<TileAddress, TileData>> paint_point_splats(const mesh::SurfaceMap& map,
                                                           const mesh::TexelGraph& graph,
                                                           std::span<const PointSplat> point_splats,
                                                           float radius, ValueType type);

}  // namespace strata::query
