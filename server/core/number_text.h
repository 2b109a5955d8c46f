#pragma once

#include <cstdio>
#include <string>

namespace strata {

// A number for people: six significant digits, no more than it has ("0.125", "1e-07").
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace strata
