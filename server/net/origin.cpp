#include "net/origin.h"

#include <algorithm>

namespace strata::net {

std::string cookie_value(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const auto end = std::min(header.find(';'), header.size());
    std::string_view pair = header.substr(0, end);
    header.remove_prefix(std::min(end + 1, header.size()));
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    while (!pair.empty() && pair.back() == ' ') pair.remove_suffix(1);
    const auto equals = pair.find('=');
    if (equals == std::string_view::npos || pair.substr(0, equals) != name) continue;
    std::string_view value = pair.substr(equals + 1);
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"') value = value.substr(1, value.size() - 2);
    return std::string(value);
  }
  return {};
}

bool is_own_origin(std::string_view origin, std::string_view host, const std::vector<std::string>& allowed,
                   bool by_https) {
  const std::string asked = to_lower(origin);
  for (const auto& entry : allowed) {
    std::string known = to_lower(entry);
    while (known.ends_with('/')) known.pop_back();
    if (asked == known) return true;
  }
  for (std::string_view scheme : {"http://", "https://"})
    if (asked.starts_with(scheme)) {
      const bool is_safe = scheme == "https://" || !by_https;
      return is_safe && !host.empty() && asked.substr(scheme.size()) == to_lower(host);
    }
  return false;
}

namespace {

bool is_own(const Request& request, const std::vector<std::string>& allowed) {
  return is_own_origin(request.header("origin"), request.header("host"), allowed, came_by_https(request));
}

}  // namespace

Result<void> check_same_origin(const Request& request, const std::vector<std::string>& allowed) {
  const auto origin = request.header("origin");
  if (request.principal && !request.principal->by_cookie) return {};
  // Signing in: a foreign page must not sign its visitor in as somebody else.
  if (!request.principal && origin.empty()) return {};
  if (!origin.empty()) {
    if (is_own(request, allowed)) return {};
    return fail(
        403, "Foreign origin",
        "Changes signed by a cookie are taken from this server's own pages only. Add the origin with --origin, or use a bearer token.",
        "Origin");
  }
  if (request.header("sec-fetch-site") == "same-origin") return {};
  return fail(403, "Origin missing",
              "Changes signed by a cookie need an Origin header of this server. Scripts use a bearer token.", "Origin");
}

Result<void> check_upgrade_origin(const Request& request, const std::vector<std::string>& allowed) {
  const auto origin = request.header("origin");
  if (origin.empty()) {
    if (request.principal && !request.principal->by_cookie) return {};
    return fail(403, "Origin missing",
                "A connection signed by a cookie needs an Origin header of this server. Scripts use a bearer token.",
                "Origin");
  }
  if (is_own(request, allowed)) return {};
  return fail(403, "Foreign origin",
              "Live connections are taken from this server's own pages only. Add the origin with --origin.", "Origin");
}

bool came_by_https(const Request& request) {
  return request.by_tls || request.header("x-forwarded-proto") == "https" ||
         request.header("origin").starts_with("https://");
}

}  // namespace strata::net
