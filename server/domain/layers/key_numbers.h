#pragma once

#include <cstdint>

namespace strata {

// A key, and the result of an expression over the columns of its record. The result of a condition
// is 1 for true and 0 for false.
struct KeyNumber {
  std::uint32_t key = 0;
  double number = 0;
};

}  // namespace strata
