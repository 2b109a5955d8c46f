#pragma once

#include <cstdint>

namespace strata {

// What an expression over the columns of records says of the record with a key; truths are 1 or 0.
struct KeyNumber {
  std::uint32_t key = 0;
  double number = 0;
};

}  // namespace strata
