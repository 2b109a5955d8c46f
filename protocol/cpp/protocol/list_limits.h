#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/messages.h"

namespace strata::protocol {

// The maximum lengths of the lists of a message, by their place in it: checked before an item is
// built.
struct ListLimits {
  std::optional<std::size_t> most;  // of a list: number of items
  std::string wanted;               // of a list: the expected content, in words
  std::shared_ptr<const ListLimits> items;
  std::map<std::string, std::shared_ptr<const ListLimits>, std::less<>> members;  // of an object
};

// Returns the limits of a schema; made once, on first use. Thread-safe.
const ListLimits& list_limits(Schema schema);

}  // namespace strata::protocol
