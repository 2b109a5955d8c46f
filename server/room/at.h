#pragma once

#include <cstdint>
#include <optional>

namespace strata::room {

// The sequence of an edit. It selects the state after this edit. nullopt: the present state.
using At = std::optional<std::int64_t>;

}  // namespace strata::room
