#pragma once

#include <string_view>

namespace strata {

// Semantic version of this release, such as "0.1.0". CMakeLists.txt has it.
std::string_view version();

}  // namespace strata
