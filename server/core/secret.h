#pragma once

#include <string>
#include <string_view>

namespace strata {

// Returns 32 random bytes in base64url without padding (43 characters).
std::string random_token();

// The running time does not depend on the position of a difference.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace strata
