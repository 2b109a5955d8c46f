#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "net/http/http_types.h"

namespace strata::net {

// Returns the value of a cookie in a Cookie header, without quotes; empty if it is absent.
std::string cookie_value(std::string_view header, std::string_view name);

// The names by which browsers reach this server, in lower case: `localhost`, the name in the listen
// address, the machine's own name, and the names of the allowed origins. Addresses (192.0.2.7,
// [2001:db8::1]) need not be listed.
std::vector<std::string> own_names(const std::string& listen_host,
                                   const std::vector<std::string>& allowed_origins);

// Refuses (421) the Host of a page whose name resolves to this server's address by DNS rebinding.
// Accepts addresses, which rebinding cannot send as Host, and requests with an Authorization
// header, which no browser adds automatically.
Result<void> check_host(const Request& request, const std::vector<std::string>& own_names);

// Whether an Origin header names this server (the host and port of the Host header, with the
// request's scheme) or one of the allowed origins.
bool is_own_origin(std::string_view origin, std::string_view host,
                   const std::vector<std::string>& allowed, bool by_https);

// A change that a browser authorizes with its cookie must come from the server's own pages, as
// shown by Origin or, if absent, by Sec-Fetch-Site. Calls with a bearer token pass. Calls without a
// principal (signing in) must not come from a foreign page.
Result<void> check_same_origin(const Request& request, const std::vector<std::string>& allowed);

// For the WebSocket's upgrade: browsers always send Origin; scripts with a bearer token may omit
// it.
Result<void> check_upgrade_origin(const Request& request, const std::vector<std::string>& allowed);

// Over TLS to this server, or to a proxy that reports it by X-Forwarded-Proto.
bool came_by_https(const Request& request);
// The same, or the page's (allowed) origin is https while a proxy reports nothing: then cookies
// must not travel without https.
bool needs_secure_cookie(const Request& request);

}  // namespace strata::net
