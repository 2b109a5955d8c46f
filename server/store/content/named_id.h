#pragma once

#include <cstdint>
#include <string>

namespace strata::store {

// By what a list that is sorted by names is in order.
struct NamedId {
  std::string name;
  std::int64_t id = 0;
};

}  // namespace strata::store
