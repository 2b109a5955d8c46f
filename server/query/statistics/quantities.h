#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/texels/texel_graph.h"
#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::query {

inline constexpr std::size_t kMaxClasses = 1'000'000;

struct Quantity {
  std::optional<double> value;     // where each value is a class
  std::optional<double> from, to;  // of a range; nothing where it is open
  std::uint64_t pieces = 0;        // connected areas, across the seams of the atlas
  std::uint64_t texels = 0;
  double area_m2 = 0;
};

struct Quantities {
  std::vector<Quantity> classes;  // those that are there, ascending
  Quantity sum;                   // of all of them
  double surface_m2 = 0;          // of the whole model
};

// How much there is of each class, over valid surface texels (gutter excluded). The map and its
// graph must be of the layer's resolution. The same on every call. Refused (invalid): more than
// kMaxClasses classes.
Result<Quantities> quantities(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const ValueClasses& classes,
                              double metres_per_unit);

}  // namespace strata::query
