#pragma once

#include <string>

namespace strata::net {

// Returns an HTML page that lists every `type` of a problem with its status, meaning and remedy.
// The page contains no scripts.
std::string problems_html();

}  // namespace strata::net
