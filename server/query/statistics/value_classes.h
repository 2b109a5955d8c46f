#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "domain/layers/layer.h"

namespace strata::query {

// The classes of a layer's values: each value is one, or each range. Class i of n limits is from
// limit i - 1 (included) to limit i; the first and the last one are open on their outer side.
struct ValueClasses {
  bool each = false;
  std::vector<double> limits{};  // of ranges, ascending; empty: all values are one class
  // a value at the last limit belongs to the range before it, as at the end of a scale
  bool last_limit_below = false;

  // Returns the bits of the value if each value is a class (zero has one sign), otherwise the
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

// The classes as the layer's legend shows them: keys, and values of a categorical palette, are
// classes; other palettes have ranges between their points.
ValueClasses classes_of(const Layer& layer);

}  // namespace strata::query
