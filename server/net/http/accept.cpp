#include "net/http/accept.h"

#include <algorithm>
#include <charconv>

#include "core/text/ascii.h"
#include "net/http/http_types.h"

namespace strata::net {
namespace {

// Removes the first entry from a list with this separator, and returns it.
std::string_view next_of(std::string_view& list, char separator) {
  const auto end = std::min(list.find(separator), list.size());
  const std::string_view part = trimmed(list.substr(0, end));
  list.remove_prefix(std::min(end + 1, list.size()));
  return part;
}

double quality_of(std::string_view parameters) {
  while (!parameters.empty()) {
    const std::string_view parameter = next_of(parameters, ';');
    if (!parameter.starts_with("q=") && !parameter.starts_with("Q=")) continue;
    double quality = 0;
    const char* end = parameter.data() + parameter.size();
    const auto read = std::from_chars(parameter.data() + 2, end, quality);
    const bool is_valid = read.ec == std::errc() && read.ptr == end && quality >= 0 && quality <= 1;
    return is_valid ? quality : 0;  // not a number compares as false
  }
  return 1;
}

// Returns how specifically a range such as `text/*` matches a type. 0 means no match.
int closeness(const std::string& range, const std::string& type) {
  if (range == type) return 4;
  const bool is_json = type.starts_with("application/") && type.ends_with("+json");
  if (range == "application/json" && is_json) return 3;
  if (range.ends_with("/*") && range != "*/*" &&
      type.starts_with(range.substr(0, range.size() - 1)))
    return 2;
  return range == "*/*" || range == "*" ? 1 : 0;
}

}  // namespace

std::vector<Accepted> accepted_values(std::string_view header) {
  std::vector<Accepted> values;
  while (!header.empty()) {
    std::string_view entry = next_of(header, ',');
    const std::string_view value = next_of(entry, ';');
    if (!value.empty()) values.push_back({to_lower(value), quality_of(entry)});
  }
  return values;
}

bool accepts_type(std::string_view accept, std::string_view content_type) {
  if (trimmed(accept).empty()) return true;
  const std::string type = to_lower(trimmed(content_type.substr(0, content_type.find(';'))));
  int closest = 0;
  double quality = 0;
  for (const Accepted& range : accepted_values(accept))
    if (const int close = closeness(range.value, type); close > closest) {
      closest = close;
      quality = range.quality;
    }
  return quality > 0;
}

}  // namespace strata::net
