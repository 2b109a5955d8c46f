#pragma once

#include <string_view>

namespace strata {

// Returns the semantic version of this release, such as "0.1.0", from CMakeLists.txt.
std::string_view version();

}  // namespace strata
