#pragma once

#include <cstdint>

namespace strata {

// The result of an expression over the columns of the record with a key; true is 1, false is 0.
struct KeyNumber {
  std::uint32_t key = 0;
  double number = 0;
};

}  // namespace strata
