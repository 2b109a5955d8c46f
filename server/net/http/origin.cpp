#include "net/http/origin.h"

#include <arpa/inet.h>
#include <unistd.h>

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
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    return std::string(value);
  }
  return {};
}

bool is_own_origin(std::string_view origin, std::string_view host,
                   const std::vector<std::string>& allowed, bool by_https) {
  const std::string lower_origin = to_lower(origin);
  for (const auto& entry : allowed) {
    std::string known = to_lower(entry);
    while (known.ends_with('/')) known.pop_back();
    if (lower_origin == known) return true;
  }
  const std::string_view scheme = by_https ? "https://" : "http://";
  return lower_origin.starts_with(scheme) && !host.empty() &&
         lower_origin.substr(scheme.size()) == to_lower(host);
}

namespace {

// Returns `museum.example` for `museum.example:8080`. An IPv6 address keeps its brackets.
std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) {
    const auto end = host.find(']');
    const bool is_whole =
        end != std::string_view::npos && (end + 1 == host.size() || host[end + 1] == ':');
    return is_whole ? host.substr(0, end + 1) : host;
  }
  return host.substr(0, host.find(':'));
}

bool is_address(std::string_view host) {
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string text(host);
  in6_addr address{};
  return inet_pton(AF_INET, text.c_str(), &address) == 1 ||
         inet_pton(AF_INET6, text.c_str(), &address) == 1;
}

}  // namespace

std::vector<std::string> own_names(const std::string& listen_host,
                                   const std::vector<std::string>& allowed_origins) {
  std::vector<std::string> names = {"localhost", to_lower(listen_host)};
  char machine[256] = {};
  if (gethostname(machine, sizeof machine - 1) == 0 && machine[0] != 0)
    names.push_back(to_lower(machine));
  for (const std::string& origin : allowed_origins) {
    const auto scheme = origin.find("://");
    std::string host = to_lower(scheme == std::string::npos ? origin : origin.substr(scheme + 3));
    host.resize(std::min(host.find('/'), host.size()));
    names.emplace_back(without_port(host));
  }
  return names;
}

Result<void> check_host(const Request& request, const std::vector<std::string>& own_names) {
  const std::string_view sent = request.header("host");
  if (sent.empty() || !request.header("authorization").empty()) return {};
  std::string host = to_lower(without_port(sent));
  if (host.ends_with('.')) host.pop_back();
  if (is_address(host) || std::ranges::find(own_names, host) != own_names.end()) return {};
  return fail(ErrorCode::misdirected, "Unknown host name",
              "The server does not accept the host name of this request. Ask an administrator to "
              "add the name with --origin (STRATA_ORIGIN), for example --origin "
              "https://museum.example.",
              "Host");
}

namespace {

bool is_own(const Request& request, const std::vector<std::string>& allowed) {
  return is_own_origin(request.header("origin"), request.header("host"), allowed,
                       came_by_https(request));
}

}  // namespace

Result<void> check_same_origin(const Request& request, const std::vector<std::string>& allowed) {
  const auto origin = request.header("origin");
  if (request.principal && !request.principal->by_cookie) return {};
  // A sign-in has no principal. A script may omit Origin, but a foreign page must not sign in.
  if (!request.principal && origin.empty()) return {};
  if (!origin.empty()) {
    if (is_own(request, allowed)) return {};
    return fail(ErrorCode::forbidden, "Cross-origin request refused",
                "If a request has a session cookie, the server accepts changes only from its own "
                "pages. Ask an administrator to add this origin with --origin, or use a bearer "
                "token.",
                "Origin");
  }
  if (request.header("sec-fetch-site") == "same-origin") return {};
  return fail(ErrorCode::forbidden, "Origin missing",
              "A change with a session cookie requires an Origin header of this server. Use a "
              "bearer token in scripts.",
              "Origin");
}

Result<void> check_upgrade_origin(const Request& request, const std::vector<std::string>& allowed) {
  const auto origin = request.header("origin");
  if (origin.empty()) {
    if (request.principal && !request.principal->by_cookie) return {};
    return fail(ErrorCode::forbidden, "Origin missing",
                "A live connection with a session cookie requires an Origin header of this server. "
                "Use a bearer token in scripts.",
                "Origin");
  }
  if (is_own(request, allowed)) return {};
  return fail(ErrorCode::forbidden, "Cross-origin request refused",
              "The server accepts live connections only from its own pages. Ask an administrator "
              "to add this origin with --origin.",
              "Origin");
}

std::string own_origin(const Request& request, const std::vector<std::string>& allowed) {
  const std::string host = to_lower(request.header("host"));
  for (const std::string& entry : allowed) {
    std::string origin = to_lower(entry);
    while (origin.ends_with('/')) origin.pop_back();
    if (origin == "https://" + host || origin == "http://" + host) return origin;
  }
  return (came_by_https(request) ? "https://" : "http://") + host;
}

bool came_by_https(const Request& request) {
  return request.by_tls || request.header("x-forwarded-proto") == "https";
}

bool needs_secure_cookie(const Request& request) {
  return came_by_https(request) || request.header("origin").starts_with("https://");
}

}  // namespace strata::net
