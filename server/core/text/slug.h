#pragma once

#include <string>
#include <string_view>

namespace strata {

// Makes a path segment from a name. It has lowercase ASCII letters, digits and hyphens, is not
// empty, and does not consist of digits only ("Muro 3" → "muro-3", "12" → "n-12"). The caller makes
// it unique within its parent.
std::string make_slug(std::string_view name);
bool is_all_digits(std::string_view text);

}  // namespace strata
