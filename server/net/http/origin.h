#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "net/http/http_types.h"

namespace strata::net {

// Value of a cookie in a Cookie header; empty when it is not there. Quotes around it are dropped.
std::string cookie_value(std::string_view header, std::string_view name);

// The names under which browsers reach this server, in lower case: `localhost`, the name that it
// listens on, the machine's own name, and those of the allowed origins. Addresses (192.0.2.7,
// [2001:db8::1]) are no names and need not be listed.
std::vector<std::string> own_names(const std::string& listen_host,
                                   const std::vector<std::string>& allowed_origins);

// A page whose name was made to lead to this server's address (DNS rebinding) sends its own name as
// Host: 421. Addresses pass, because no name leads there, and so do requests with an Authorization
// header, which no browser sends by itself.
Result<void> check_host(const Request& request, const std::vector<std::string>& own_names);

// Whether an Origin header names this server (the host and port of the Host header, with the scheme
// by which the request came) or one of the allowed origins.
bool is_own_origin(std::string_view origin, std::string_view host,
                   const std::vector<std::string>& allowed, bool by_https);

// A changing call that a browser signed with its cookie must come from our own pages: by Origin,
// or, where the browser sends none, by Sec-Fetch-Site. Calls with a bearer token pass. Calls of
// nobody (signing in) must not come from a foreign page.
Result<void> check_same_origin(const Request& request, const std::vector<std::string>& allowed);

// At the WebSocket's upgrade: browsers always send Origin; scripts may leave it out when they bring
// a bearer token.
Result<void> check_upgrade_origin(const Request& request, const std::vector<std::string>& allowed);

// By TLS to this server, or to a proxy before it that says so by X-Forwarded-Proto.
bool came_by_https(const Request& request);
// The same, or the page says so by its (allowed) origin, where a proxy says nothing: then cookies
// must not travel without https.
bool needs_secure_cookie(const Request& request);

}  // namespace strata::net
