#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace strata {

// How numbers are put into classes, as maps do it.
enum class ClassMethod {
  equal,     // intervals of one width
  quantile,  // as many numbers in each, as far as equal numbers stay together
};

struct NumberClass {
  double from = 0, to = 0;  // from ≤ number < to; in the last one the largest number, too
  std::uint64_t count = 0;
};
// Ascending classes that hold all `numbers` (finite, any order), `count` at most: empty ones are
// left out for quantiles, and numbers that are all the same make one class.
std::vector<NumberClass> classify(std::span<const double> numbers, ClassMethod method, int count);

struct TextClass {
  std::string value;
  std::uint64_t count = 0;
};
// The distinct values, the most frequent ones first.
std::vector<TextClass> classify(std::span<const std::string> values);

}  // namespace strata
