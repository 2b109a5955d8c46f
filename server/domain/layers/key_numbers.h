#pragma once

#include <cstdint>

namespace strata {

// A key, and the result of an expression over the columns of its record. 1 means true, 0 means
// false.
struct KeyNumber {
  std::uint32_t key = 0;
  double number = 0;
};

}  // namespace strata
