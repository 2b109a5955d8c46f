#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace strata {

// Methods that divide numbers into classes, as on maps.
enum class ClassMethod {
  equal,     // intervals of equal width
  quantile,  // classes with equal counts of numbers, but equal numbers are in one class
};

struct NumberClass {
  // A class contains the numbers from ≤ number < to. The last class also contains `to`.
  double from = 0, to = 0;
  std::uint64_t count = 0;
};
// Divides `numbers` (finite, in any order) into at most `count` ascending classes. The method
// `quantile` omits empty classes. If all numbers are equal, they form one class.
std::vector<NumberClass> classify(std::span<const double> numbers, ClassMethod method, int count);

struct TextClass {
  std::string value;
  std::uint64_t count = 0;
};
// Returns the distinct values, starting with the most frequent one.
std::vector<TextClass> classify(std::span<const std::string> values);

}  // namespace strata
