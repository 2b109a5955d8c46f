#pragma once

#include <array>
#include <optional>

#include "query/sampling/values.h"
#include "query/statistics/tile_sums.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

// The smallest values that are not exceeded on 5, 25, 50, 75 and 95 % of the area.
constexpr std::array<double, 5> kQuantiles = {0.05, 0.25, 0.5, 0.75, 0.95};
constexpr std::array<const char*, kQuantiles.size()> kQuantileNames = {"p5", "p25", "p50", "p75",
                                                                       "p95"};
using Quantiles = std::array<double, kQuantiles.size()>;

// Returns the exact quantiles of the texels counted in `sums`, or nothing if they have no area.
std::optional<Quantiles> quantiles(const LayerView& view, const mesh::SurfaceMap& map,
                                   const TexelSelection* within, const TileSums& sums);

}  // namespace strata::query
