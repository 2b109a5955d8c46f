#pragma once

#include <string>
#include <string_view>

namespace strata {

// Escapes a text for the content and the attributes of HTML and XML.
std::string escaped_markup(std::string_view text);

}  // namespace strata
