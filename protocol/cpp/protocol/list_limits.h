#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "protocol/messages.h"

namespace strata::protocol {

// How long the lists of a message may be, by the place where they stand: known before any of their
// items is built.
struct ListLimits {
  std::optional<std::size_t> most;  // of a list: its items
  std::string wanted;               // of a list: what belongs there, in words
  std::shared_ptr<const ListLimits> items;
  std::map<std::string, std::shared_ptr<const ListLimits>, std::less<>> members;  // of an object
};

// Of a schema; made once, on first use. Thread-safe.
const ListLimits& list_limits(Schema schema);

}  // namespace strata::protocol
