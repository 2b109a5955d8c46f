#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "domain/layers/layer.h"
#include "query/regions/surface_values.h"

namespace strata {
class Progress;
}
namespace strata::mesh {
struct TexelGraph;
}

namespace strata::query {

// A spot of connected texels with one value, also across seams. It is one measurement: the mean of
// the measured quantity over the spot.
struct Reading {
  double value = 0;
  std::vector<std::uint32_t> texels;  // not empty
};

// Returns the readings in the order of their lowest texels. Texels whose value is not a finite
// number do not count. `type` is the type of `values`. If there are more than `max_readings`,
// returns the first max_readings + 1 of them. Fails when cancelled.
Result<std::vector<Reading>> find_readings(const SurfaceValues& values, ValueType type,
                                           const mesh::SurfaceMap& map,
                                           const mesh::TexelGraph& graph, std::size_t max_readings,
                                           const Progress& progress);

}  // namespace strata::query
