#pragma once

#include <cstdint>
#include <optional>

namespace strata::room {

// The sequence of an edit: what is asked for is meant as it was after it. Nothing: as it is.
using At = std::optional<std::int64_t>;

}  // namespace strata::room
