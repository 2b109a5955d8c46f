#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "domain/layers/layer.h"

namespace strata::query {

// How the values of a layer are told apart: each by itself, or by the range that it lies in. Class
// i of n limits goes from limit i - 1 (included) to limit i; the first and the last one are open to
// their side.
struct ValueClasses {
  bool each = false;
  std::vector<double> limits{};  // of ranges, ascending; none: all values are one class
  // a value at the last limit belongs to the range before it, as at the end of a scale
  bool last_limit_below = false;

  // The bits of the value where each is a class of its own (zero has one sign), otherwise the
  // number of its range.
  std::uint32_t of(std::uint32_t bits, double value) const {
    if (each) return value == 0 ? 0 : bits;
    auto limit = std::upper_bound(limits.begin(), limits.end(), value);
    if (last_limit_below && !limits.empty() && value == limits.back()) --limit;
    return static_cast<std::uint32_t>(limit - limits.begin());
  }
  std::optional<double> from(std::uint32_t range) const {
    return range == 0 ? std::nullopt : std::optional(limits[range - 1]);
  }
  std::optional<double> to(std::uint32_t range) const {
    return range == limits.size() ? std::nullopt : std::optional(limits[range]);
  }
};

// As its legend shows a layer: keys, and values of a categorical palette, are classes; between the
// points of the others lie ranges.
ValueClasses classes_of(const Layer& layer);

}  // namespace strata::query
