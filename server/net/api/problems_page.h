#pragma once

#include <string>
#include <string_view>

namespace strata::net {

// Returns an HTML page that lists every `type` of a problem with its status, meaning and remedy.
// The page contains no scripts.
std::string problems_html();
std::string html_escape(std::string_view text);

}  // namespace strata::net
