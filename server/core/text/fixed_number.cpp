#include "core/text/fixed_number.h"

#include <charconv>
#include <string_view>

namespace strata {

void append_fixed(std::string& text, double value, int decimals) {
  char digits[400];  // the largest double has 309 digits before the decimal point
  char* end =
      std::to_chars(digits, digits + sizeof digits, value, std::chars_format::fixed, decimals).ptr;
  if (decimals > 0) {
    while (end[-1] == '0') --end;
    if (end[-1] == '.') --end;
  }
  const std::string_view number(digits, static_cast<std::size_t>(end - digits));
  text += number == "-0" ? "0" : number;
}

}  // namespace strata
