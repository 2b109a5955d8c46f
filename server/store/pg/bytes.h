#pragma once

#include <cstdint>
#include <span>

namespace strata::store {

using Bytes = std::span<const std::uint8_t>;

}  // namespace strata::store
