#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "query/conditions/texel_selection.h"
#include "query/sampling/values.h"

namespace strata::mesh {
struct SurfaceMap;
}  // namespace strata::mesh

namespace strata::query {

constexpr std::size_t kMaxCrossTableSide = 1024;  // limit for the distinct values of one layer

// The true surface area of each pair of values of two layers.
struct CrossTable {
  using Key = std::optional<double>;         // empty if the layer has no value
  std::vector<Key> rows, columns;            // the values that occur, ascending; the empty one last
  std::vector<std::vector<double>> area_m2;  // indexed by row, then by column
  std::vector<std::vector<std::uint64_t>> texels;
  double neither_m2 = 0;  // the area where neither layer has a value
};

// Sums the areas of the surface texels of `map`. Rows and columns are those of texels where at
// least one of the layers has a value. `within` restricts the texels; null means all texels. For a
// layer with another resolution, the layer texel that contains the center of the map texel is used.
// Returns an `invalid` error for a floating-point layer, or for one with more than
// kMaxCrossTableSide values.
Result<CrossTable> cross_tabulate(const LayerView& rows, const LayerView& columns,
                                  const mesh::SurfaceMap& map, const TexelSelection* within,
                                  double metres_per_unit);

}  // namespace strata::query
