#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace strata {

// Methods that divide numbers into classes, as for maps.
enum class ClassMethod {
  equal,     // intervals of equal width
  quantile,  // equal counts, except that equal numbers stay together
};

struct NumberClass {
  double from = 0, to = 0;  // from ≤ number < to; the last class includes the largest number
  std::uint64_t count = 0;
};
// Returns at most `count` ascending classes that contain all `numbers` (finite, any order).
// Quantiles leave out empty classes, and equal numbers form one class.
std::vector<NumberClass> classify(std::span<const double> numbers, ClassMethod method, int count);

struct TextClass {
  std::string value;
  std::uint64_t count = 0;
};
// Returns the distinct values, the most frequent first.
std::vector<TextClass> classify(std::span<const std::string> values);

}  // namespace strata
