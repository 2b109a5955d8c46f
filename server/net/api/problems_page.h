#pragma once

#include <string>
#include <string_view>

namespace strata::net {

// Lists every `type` of a problem with its status, meaning and remedy: a page without scripts.
std::string problems_html();
std::string html_escape(std::string_view text);

}  // namespace strata::net
