#include "mesh/io/plain_text.h"

namespace strata::mesh {
namespace {

constexpr std::uint32_t kReplacement = 0xfffd;

void append_utf8(std::uint32_t code, std::vector<std::uint8_t>& out) {
  const auto put = [&](std::uint32_t byte) { out.push_back(static_cast<std::uint8_t>(byte)); };
  if (code < 0x80) return put(code);
  if (code < 0x800) {
    put(0xc0 | code >> 6);
  } else if (code < 0x10000) {
    put(0xe0 | code >> 12);
    put(0x80 | (code >> 6 & 63));
  } else {
    put(0xf0 | code >> 18);
    put(0x80 | (code >> 12 & 63));
    put(0x80 | (code >> 6 & 63));
  }
  put(0x80 | (code & 63));
}

// Follows RFC 2781. Half of a surrogate pair or an odd byte at the end becomes U+FFFD.
std::vector<std::uint8_t> utf8_of_utf16(std::span<const std::uint8_t> bytes, bool big_endian) {
  const auto unit = [&](std::size_t i) {
    return static_cast<std::uint32_t>(big_endian ? bytes[i] << 8 | bytes[i + 1]
                                                 : bytes[i + 1] << 8 | bytes[i]);
  };
  std::vector<std::uint8_t> out;
  out.reserve(bytes.size() / 2 + 3);
  std::size_t i = 0;
  for (; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xd800 && code < 0xe000) {
      const std::uint32_t low = code < 0xdc00 && i + 3 < bytes.size() ? unit(i + 2) : 0;
      if (low >= 0xdc00 && low < 0xe000) {
        code = 0x10000 + ((code & 0x3ff) << 10 | (low & 0x3ff));
        i += 2;
      } else {
        code = kReplacement;
      }
    }
    append_utf8(code, out);
  }
  if (i < bytes.size()) append_utf8(kReplacement, out);
  return out;
}

}  // namespace

std::size_t utf8_mark(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xef && bytes[1] == 0xbb && bytes[2] == 0xbf ? 3 : 0;
}

PlainText::PlainText(std::span<const std::uint8_t> bytes)
    : bytes_(bytes.subspan(utf8_mark(bytes))) {
  if (bytes.size() < 2) return;
  const bool little = bytes[0] == 0xff && bytes[1] == 0xfe,
             big = bytes[0] == 0xfe && bytes[1] == 0xff;
  if (!little && !big) return;
  decoded_ = utf8_of_utf16(bytes.subspan(2), big);
  bytes_ = decoded_;
}

}  // namespace strata::mesh
