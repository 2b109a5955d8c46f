#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "domain/layers/layer.h"

namespace strata::query {

// The classes of the values of a layer: each value is a class, or each range is a class. Range i
// extends from limit i - 1 (included) to limit i. The first and the last range are open on their
// outer sides.
struct ValueClasses {
  bool each = false;
  std::vector<double> limits{};  // limits of ranges, ascending; if empty, all values are one class
  // true if a value at the last limit belongs to the range before it, as at the end of a scale
  bool last_limit_below = false;

  // Returns the bits of the value if each value is a class (-0 becomes 0), otherwise the number of
  // its range.
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

// Returns the classes that the legend of the layer shows. Keys, and values of a categorical
// palette, are classes. Other palettes have ranges between their points.
ValueClasses classes_of(const Layer& layer);

}  // namespace strata::query
