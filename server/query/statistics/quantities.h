#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "query/sampling/values.h"
#include "query/statistics/value_classes.h"

namespace strata::mesh {
struct SurfaceMap;
struct TexelGraph;
}  // namespace strata::mesh

namespace strata::query {

inline constexpr std::size_t kMaxClasses = 1'000'000;

struct Quantity {
  std::optional<double> value;     // if each value is a class
  std::optional<double> from, to;  // of a range; empty on an open side
  std::uint64_t pieces = 0;        // connected areas, across the seams of the atlas
  std::uint64_t texels = 0;
  double area_m2 = 0;
};

struct Quantities {
  std::vector<Quantity> classes;  // classes that occur, ascending
  Quantity sum;                   // of all of them
  double surface_m2 = 0;          // of the whole model
};

// The amount of each class, over valid surface texels (gutter excluded). The map and its graph must
// be of the layer's resolution. The same result on every call. Refused (invalid): more than
// kMaxClasses classes.
Result<Quantities> quantities(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const ValueClasses& classes,
                              double metres_per_unit);

}  // namespace strata::query
