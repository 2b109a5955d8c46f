#include "core/text/url.h"

#include <algorithm>
#include <optional>

namespace strata {
namespace {

constexpr std::string_view kHttps = "https://", kHttp = "http://";

bool may_stand_in_url(char c) {
  return c > ' ' && c < 0x7f && std::string_view("\"<>\\^`{|}#").find(c) == std::string_view::npos;
}

// Returns the host without the port, or nothing if the URL is not valid.
std::optional<std::string_view> host_of(std::string_view url) {
  const std::string_view scheme = url.starts_with(kHttps) ? kHttps : kHttp;
  if (!url.starts_with(scheme) || !std::ranges::all_of(url, may_stand_in_url)) return std::nullopt;
  std::string_view host = url.substr(scheme.size());
  host = host.substr(0, host.find_first_of("/?"));
  if (host.find('@') != std::string_view::npos) return std::nullopt;
  const auto end = host.starts_with('[') ? host.find(']') + 1 : host.find(':');
  host = host.substr(0, end);
  return host.empty() ? std::nullopt : std::optional(host);
}

}  // namespace

bool is_loopback_url(std::string_view url) {
  const auto host = host_of(url);
  return host && (*host == "127.0.0.1" || *host == "[::1]" || *host == "localhost");
}

bool is_safe_url(std::string_view url) {
  return host_of(url) && (url.starts_with(kHttps) || is_loopback_url(url));
}

}  // namespace strata
