#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "net/http_types.h"

namespace strata::net {

// Value of a cookie in a Cookie header; empty when it is not there. Quotes around it are dropped.
std::string cookie_value(std::string_view header, std::string_view name);

// Whether an Origin header names this server (the host and port of the Host header) or one of the allowed origins. A server that is asked by https is
// not itself in the clear, where a page may be anybody's.
bool is_own_origin(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed,
                   bool by_https);

// A changing call that a browser signed with its cookie must come from our own pages: by Origin, or, where the browser
// sends none, by Sec-Fetch-Site. Calls with a bearer token pass. Calls of nobody (signing in) must not come from a foreign page.
Result<void> check_same_origin(const Request& request, const std::vector<std::string>& allowed);

// At the WebSocket's upgrade: browsers always send Origin; scripts may leave it out when they bring a bearer token.
Result<void> check_upgrade_origin(const Request& request, const std::vector<std::string>& allowed);

// To this server or to a proxy before it: then cookies must not travel without it.
bool came_by_https(const Request& request);

}  // namespace strata::net
