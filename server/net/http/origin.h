#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "net/http/http_types.h"

namespace strata::net {

// Returns the value of a cookie in a Cookie header, without quotation marks. Returns an empty text
// if it is absent.
std::string cookie_value(std::string_view header, std::string_view name);

// Returns the names by which browsers reach this server, in lower case. These are `localhost`, the
// name in the listen address, the host name of the machine, and the names of the allowed origins.
// IP addresses (192.0.2.7, [2001:db8::1]) need not be listed.
std::vector<std::string> own_names(const std::string& listen_host,
                                   const std::vector<std::string>& allowed_origins);

// Prevents DNS rebinding, in which the name of a foreign page resolves to the address of this
// server. Refuses (421) a Host that is not one of `own_names`. Accepts IP addresses, because a
// rebinding page cannot send one as Host. Accepts requests with an Authorization header, because no
// browser adds that header automatically.
Result<void> check_host(const Request& request, const std::vector<std::string>& own_names);

// Returns whether an Origin header names this server or one of the allowed origins. This server has
// the host and port in the Host header and the scheme of the request.
bool is_own_origin(std::string_view origin, std::string_view host,
                   const std::vector<std::string>& allowed, bool by_https);

// Checks that a change with a session cookie comes from the server's own pages. Reads Origin or, if
// it is absent, Sec-Fetch-Site. Accepts calls with a bearer token. A call without a principal, such
// as signing in, must not come from a foreign page.
Result<void> check_same_origin(const Request& request, const std::vector<std::string>& allowed);

// Checks the upgrade to a WebSocket. Browsers always send Origin. Scripts with a bearer token may
// omit it.
Result<void> check_upgrade_origin(const Request& request, const std::vector<std::string>& allowed);

// Returns the origin by which the browser reaches this server, without a `/` at the end. This is
// the allowed origin with the requested host, or else the request's scheme and host.
std::string own_origin(const Request& request, const std::vector<std::string>& allowed);

// Returns whether the request used TLS to this server, or to a proxy that reports it in
// X-Forwarded-Proto.
bool came_by_https(const Request& request);
// Like `came_by_https`, but also returns true if the allowed origin of the page uses https and a
// proxy reports nothing. In this case, cookies require https.
bool needs_secure_cookie(const Request& request);

}  // namespace strata::net
