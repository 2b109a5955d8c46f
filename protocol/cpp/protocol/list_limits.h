#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/messages.h"

namespace strata::protocol {

// The maximum lengths of the lists in a message, by their position in the message. They are checked
// before an item is built.
struct ListLimits {
  std::optional<std::size_t> most;  // for a list: the maximum number of items
  std::string wanted;               // for a list: description of the expected content
  std::shared_ptr<const ListLimits> items;
  std::map<std::string, std::shared_ptr<const ListLimits>, std::less<>> members;  // for an object
};

// Returns the limits of a schema. They are computed once, at the first use. Thread-safe.
const ListLimits& list_limits(Schema schema);

}  // namespace strata::protocol
