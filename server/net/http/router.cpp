#include "net/http/router.h"

#include <algorithm>

namespace strata::net {

void Router::add(Route route) {
  Entry entry;
  const std::string& pattern = route.pattern;
  for (std::size_t begin = 1; begin <= pattern.size();) {
    const std::size_t end = std::min(pattern.find('/', begin), pattern.size());
    const std::string text = pattern.substr(begin, end - begin);
    Segment segment;
    const auto open = text.find('{');
    if (open == std::string::npos) {
      segment.prefix = text;
    } else {
      const auto close = text.find('}', open);
      segment.prefix = text.substr(0, open);
      segment.param = text.substr(open + 1, close - open - 1);
      segment.suffix = text.substr(close + 1);
    }
    entry.segments.push_back(std::move(segment));
    begin = end + 1;
  }
  entry.route = std::move(route);
  entries_.push_back(std::move(entry));
}

bool Router::matches(const Entry& entry, const std::vector<std::string>& segments,
                     std::map<std::string, std::string>& params) {
  if (entry.segments.size() != segments.size()) return false;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = entry.segments[i];
    const std::string& text = segments[i];
    if (segment.param.empty()) {
      if (text != segment.prefix) return false;
      continue;
    }
    if (text.size() <= segment.prefix.size() + segment.suffix.size()) return false;
    if (!text.starts_with(segment.prefix) || !text.ends_with(segment.suffix)) return false;
    params[segment.param] = text.substr(
        segment.prefix.size(), text.size() - segment.prefix.size() - segment.suffix.size());
  }
  return true;
}

Router::Match Router::find(Method method, const std::vector<std::string>& segments) const {
  const Method effective = method == Method::head ? Method::get : method;
  Match match;
  for (const Entry& entry : entries_) {
    std::map<std::string, std::string> params;
    if (!matches(entry, segments, params)) continue;
    if (entry.route.method == effective) {
      match.route = &entry.route;
      match.params = std::move(params);
      return match;
    }
    match.allowed.push_back(entry.route.method);
    if (entry.route.method == Method::get) match.allowed.push_back(Method::head);
  }
  if (!match.allowed.empty()) match.allowed.push_back(Method::options);
  return match;
}

std::string allow_header(const std::vector<Method>& methods) {
  std::string text;
  for (Method method : methods) {
    if (!text.empty()) text += ", ";
    text += name(method);
  }
  return text;
}

Result<void> check_query(const Route& route, const Request& request) {
  if (route.any_query) return {};
  for (const auto& [key, value] : request.query) {
    if (std::find(route.query.begin(), route.query.end(), key) != route.query.end()) continue;
    std::string known;
    for (const auto& name : route.query) known += (known.empty() ? "" : ", ") + name;
    return fail(ErrorCode::malformed, "Unknown query parameter",
                known.empty() ? "This address accepts no query parameters."
                              : "This address accepts: " + known + ".",
                key);
  }
  return {};
}

}  // namespace strata::net
