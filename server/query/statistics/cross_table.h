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

constexpr std::size_t kMaxCrossTableSide = 1024;  // distinct values of one layer

// The area of each pair of values of two layers, weighted by true surface area.
struct CrossTable {
  using Key = std::optional<double>;         // nothing: the layer has no value there
  std::vector<Key> rows, columns;            // values that occur, ascending, nothing last
  std::vector<std::vector<double>> area_m2;  // a row's columns
  std::vector<std::vector<std::uint64_t>> texels;
};

// Counts surface texels of `map`, within `within` (null: all), where at least one of the layers has
// a value. For a layer of another resolution, the texel that contains the center of the map's texel
// counts. Refused (invalid): a layer of fractions, or of more than kMaxCrossTableSide values.
Result<CrossTable> cross_tabulate(const LayerView& rows, const LayerView& columns,
                                  const mesh::SurfaceMap& map, const TexelSelection* within,
                                  double metres_per_unit);

}  // namespace strata::query
