#include <algorithm>
#include <string_view>

#include "store/nodes/nodes.h"

namespace strata::store {
namespace {

constexpr std::size_t kMaxUrlLength = 255;

bool is_alphanumeric(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

bool consists_of(std::string_view text, std::string_view others) {
  return std::ranges::all_of(
      text, [&](char c) { return is_alphanumeric(c) || others.find(c) != std::string_view::npos; });
}

bool is_port(std::string_view text) {
  if (text.empty() || text.size() > 5) return false;
  int number = 0;
  for (const char c : text) {
    if (c < '0' || c > '9') return false;
    number = 10 * number + (c - '0');
  }
  return number >= 1 && number <= 65535;
}

// HOST or HOST:PORT. An IPv6 address is in brackets.
bool is_authority(std::string_view text) {
  std::size_t end = 0;
  if (text.starts_with('[')) {
    end = text.find(']');
    if (end == std::string_view::npos || !consists_of(text.substr(1, end - 1), ":.")) return false;
    if (end++ < 2) return false;
  } else {
    end = std::min(text.find(':'), text.size());
    if (end == 0 || !consists_of(text.substr(0, end), ".-")) return false;
  }
  return end == text.size() || (text[end] == ':' && is_port(text.substr(end + 1)));
}

}  // namespace

Result<std::string> check_node_url(const std::string& url) {
  const auto invalid = [] {
    return fail(ErrorCode::malformed, "Invalid node URL",
                "Enter the address at which the site reaches this node: an http or https URL, with "
                "a path if a proxy needs one, and without a user, query or fragment. For example, "
                "https://strata.example.org/node/a. It can have at most 255 characters.",
                "--node-url");
  };
  if (url.size() > kMaxUrlLength) return invalid();
  std::string_view rest = url;
  if (rest.starts_with("https://"))
    rest.remove_prefix(8);
  else if (rest.starts_with("http://"))
    rest.remove_prefix(7);
  else
    return invalid();
  const std::size_t path = std::min(rest.find('/'), rest.size());
  if (!is_authority(rest.substr(0, path))) return invalid();
  if (!consists_of(rest.substr(path), "/-._~%!$&'()*+,;=:")) return invalid();
  std::string checked = url;
  while (checked.ends_with('/')) checked.pop_back();
  return checked;
}

}  // namespace strata::store
