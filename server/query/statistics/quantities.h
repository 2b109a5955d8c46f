#pragma once

#include <algorithm>
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
  std::optional<double> value;     // the class, if each value is a class
  std::optional<double> from, to;  // the range, if the class is a range; empty on an open side
  std::uint64_t pieces = 0;        // connected areas; seams of the atlas do not separate them
  std::uint64_t texels = 0;
  double area_m2 = 0;
};

struct Quantities {
  std::vector<Quantity> classes;  // the classes that occur, ascending
  Quantity sum;                   // sum over all classes
  double surface_m2 = 0;          // area of the whole model
};

// Returns the fraction of the surface that an area has, from 0 to 1. Rounding can make the sum of
// areas larger than the surface.
inline double share_of_surface(double area_m2, double surface_m2) {
  return surface_m2 > 0 ? std::min(1.0, area_m2 / surface_m2) : 0;
}

// Returns the quantities of each class, over valid surface texels without the gutter. The map and
// its graph must have the resolution of the layer. Equal inputs give equal results. Returns an
// `invalid` error for more than kMaxClasses classes.
Result<Quantities> quantities(const LayerView& view, const mesh::SurfaceMap& map,
                              const mesh::TexelGraph& graph, const ValueClasses& classes,
                              double metres_per_unit);

}  // namespace strata::query
