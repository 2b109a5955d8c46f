#pragma once

#include <string_view>

namespace strata {

// Returns whether a text is written from right to left, such as Arabic and Hebrew: whether its
// first letter is (UAX #9, rules P2 and P3, without isolates). The text is UTF-8.
bool is_right_to_left(std::string_view text);

}  // namespace strata
