#include "core/text/percent.h"

#include "core/text/hex.h"

namespace strata {
namespace {

// Returns the byte of the escape at the beginning of `text`, or -1 without an escape.
int escaped_byte(std::string_view text) {
  if (text.size() < 3 || text[0] != '%') return -1;
  const int high = hex_digit_value(text[1]), low = hex_digit_value(text[2]);
  return high < 0 || low < 0 ? -1 : high * 16 + low;
}

// Sets `wrong` if an escape is invalid, and then keeps its percent sign.
std::string decoded(std::string_view text, bool& wrong) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const int byte = escaped_byte(text);
    wrong |= byte < 0 && text[0] == '%';
    out += byte < 0 ? text[0] : static_cast<char>(byte);
    text.remove_prefix(byte < 0 ? 1 : 3);
  }
  return out;
}

}  // namespace

std::string percent_encode(std::string_view text) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string out;
  for (const unsigned char c : text) {
    if ((c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' ||
        c == '.' || c == '_' || c == '~')
      out += static_cast<char>(c);
    else
      out.append({'%', kDigits[c >> 4], kDigits[c & 15]});
  }
  return out;
}

std::optional<std::string> percent_decode(std::string_view text) {
  bool wrong = false;
  std::string out = decoded(text, wrong);
  if (wrong || out.find('\0') != std::string::npos) return std::nullopt;
  return out;
}

std::string percent_decode_leniently(std::string_view text) {
  bool wrong = false;
  return decoded(text, wrong);
}

}  // namespace strata
