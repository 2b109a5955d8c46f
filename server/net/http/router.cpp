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
    auto open = text.find('{');
    segment.before = text.substr(0, open);
    while (open != std::string::npos) {
      const auto close = text.find('}', open);
      const auto next = text.find('{', close);
      segment.params.push_back(
          {text.substr(open + 1, close - open - 1), text.substr(close + 1, next - close - 1)});
      open = next;
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
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (!entry.segments[i].matches(segments[i], params)) return false;
  return true;
}

bool Router::Segment::matches(const std::string& text,
                              std::map<std::string, std::string>& values) const {
  if (params.empty()) return text == before;
  if (!text.starts_with(before)) return false;
  std::size_t begin = before.size();
  for (const Param& param : params) {
    const bool is_last = &param == &params.back();
    if (is_last && !text.ends_with(param.after)) return false;
    const std::size_t end =
        is_last ? text.size() - param.after.size() : text.find(param.after, begin + 1);
    if (end == std::string::npos || end <= begin) return false;
    values[param.name] = text.substr(begin, end - begin);
    begin = end + param.after.size();
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
