#pragma once

#include <cstdint>
#include <string>

namespace strata::store {

// The sort key of lists that are sorted by name.
struct NamedId {
  std::string name;
  std::int64_t id = 0;
};

}  // namespace strata::store
