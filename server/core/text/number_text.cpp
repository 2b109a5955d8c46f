#include "core/text/number_text.h"

#include <charconv>
#include <cstdio>

namespace strata {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Result<std::int64_t> parse_integer(std::string_view text, std::int64_t low, std::int64_t high,
                                   const std::string& field) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    return fail(ErrorCode::invalid, "Number out of range",
                "'" + field + "' must be a whole number from " + std::to_string(low) + " to " +
                    std::to_string(high) + ".",
                field);
  return value;
}

}  // namespace strata
