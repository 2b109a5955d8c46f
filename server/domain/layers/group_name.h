#pragma once

#include <cstddef>

namespace strata {

constexpr std::size_t kMaxGroupLength = 60;  // characters of the heading of a group of layers

}  // namespace strata
