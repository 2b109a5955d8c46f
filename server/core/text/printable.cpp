#include "core/text/printable.h"

#include "core/text/utf8.h"

namespace strata {

std::string printable(const std::string& text) {
  const std::string mended = mended_utf8(text);
  std::string out;
  out.reserve(mended.size());
  for (std::size_t at = 0; at < mended.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(mended[at + i]); };
    const unsigned char first = byte(0);
    const std::size_t size = first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
    const bool is_control = first == 0x7f || (first < 0x20 && first != '\t' && first != '\n') ||
                            (first == 0xc2 && byte(1) < 0xa0);
    const bool is_no_character = first == 0xef && byte(1) == 0xbf && byte(2) >= 0xbe;
    if (!is_control && !is_no_character) out.append(mended, at, size);
    at += size;
  }
  return out;
}

}  // namespace strata
