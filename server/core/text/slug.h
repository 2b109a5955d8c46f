#pragma once

#include <string>
#include <string_view>

namespace strata {

// Makes a path segment from a name: lower-case ASCII letters, digits and hyphens, never empty and
// never all digits ("Muro 3" → "muro-3", "12" → "n-12"). The caller makes it unique within its
// parent.
std::string make_slug(std::string_view name);
bool is_all_digits(std::string_view text);

}  // namespace strata
