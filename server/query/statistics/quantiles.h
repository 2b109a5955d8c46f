#pragma once

#include <array>
#include <optional>

#include "query/sampling/values.h"
#include "query/statistics/tile_sums.h"

namespace strata::query {

// The smallest values that the lower 5, 25, 50, 75 and 95 % of the area do not exceed.
constexpr std::array<double, 5> kQuantiles = {0.05, 0.25, 0.5, 0.75, 0.95};
using Quantiles = std::array<double, kQuantiles.size()>;

// Exact, of the texels that `sums` counted. Nothing where they have no area.
std::optional<Quantiles> quantiles(const LayerView& view, const mesh::SurfaceMap& map,
                                   const TexelSelection* within, const TileSums& sums);

}  // namespace strata::query
