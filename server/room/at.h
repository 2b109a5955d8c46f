#pragma once

#include <cstdint>
#include <optional>

namespace strata::room {

// The sequence of an edit: selects the state after it. Nothing: the present state.
using At = std::optional<std::int64_t>;

}  // namespace strata::room
