#pragma once

#include <string>
#include <string_view>

namespace strata::net {

// Every `type` of a problem, with its status, its meaning and what to do: a page without scripts.
std::string problems_html();
std::string html_escape(std::string_view text);

}  // namespace strata::net
