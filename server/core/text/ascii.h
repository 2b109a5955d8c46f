#pragma once

#include <string>
#include <string_view>

namespace strata {

// Only A to Z change: for names of protocols and files, whatever the locale is.
inline std::string to_lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

}  // namespace strata
