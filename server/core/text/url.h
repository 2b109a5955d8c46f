#pragma once

#include <string_view>

namespace strata {

// Returns whether the URL uses https, or http to this machine (127.0.0.1, ::1 or localhost).
// Refuses user names and fragments, and characters that a URL cannot contain.
bool is_safe_url(std::string_view url);
bool is_loopback_url(std::string_view url);  // http or https to this machine

}  // namespace strata
