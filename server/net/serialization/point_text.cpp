#include "net/serialization/point_text.h"

#include <charconv>
#include <cmath>

#include "domain/scene/model.h"
#include "net/http/http_types.h"

namespace strata::net {
namespace {

void skip_spaces(std::string_view& text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
}

bool take(std::string_view& text, std::string_view word) {
  if (to_lower(text.substr(0, word.size())) != word) return false;
  text.remove_prefix(word.size());
  return true;
}

}  // namespace

Result<glm::dvec3> parse_point(std::string_view text) {
  auto wrong = [] {
    return fail(ErrorCode::invalid, "Invalid point",
                "Write coordinates as `POINT Z(x y z)`: three numbers, separated by spaces, in "
                "the unit of the model.",
                "coords");
  };
  skip_spaces(text);
  if (!take(text, "point")) return wrong();
  skip_spaces(text);
  take(text, "z");
  skip_spaces(text);
  if (!take(text, "(")) return wrong();
  glm::dvec3 point{0};
  for (int i = 0; i < 3; ++i) {
    skip_spaces(text);
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), point[i]);
    if (error != std::errc() || !std::isfinite(point[i])) return wrong();
    const auto used = static_cast<std::size_t>(end - text.data());
    text.remove_prefix(used);
    // Refuses "1 2.3.4", which would otherwise parse as three numbers.
    if (i < 2 && (text.empty() || (text.front() != ' ' && text.front() != '\t'))) return wrong();
  }
  skip_spaces(text);
  if (!take(text, ")")) return wrong();
  skip_spaces(text);
  if (!text.empty()) return wrong();
  return point;
}

Result<double> parse_length(std::string_view text, const std::string& field) {
  double length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  std::string_view unit = text.substr(static_cast<std::size_t>(end - text.data()));
  skip_spaces(unit);
  const auto known = parse_unit(unit);
  if (error == std::errc() && known) length *= metres_per(*known);
  if (error != std::errc() || !known || !(length >= 1e-6 && length <= 1e6))
    return fail(ErrorCode::invalid, "Invalid length",
                "`" + field +
                    "` must be a length on the object with a unit, such as 5mm, 2.5cm or 1m. The "
                    "smallest length is 0.001 mm.",
                field);
  return length;
}

}  // namespace strata::net
