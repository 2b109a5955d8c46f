#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace strata::mesh {

// The text of a file in the form that the readers of text formats take: without a byte order mark,
// and UTF-8 where that mark says UTF-16. Anything else stays as it is, byte for byte. What it gives
// is valid as long as it and `bytes` are.
class PlainText {
 public:
  explicit PlainText(std::span<const std::uint8_t> bytes);
  PlainText(const PlainText&) = delete;
  PlainText& operator=(const PlainText&) = delete;

  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> decoded_;
  std::span<const std::uint8_t> bytes_;
};

// Bytes of a UTF-8 byte order mark at the beginning: 0 or 3.
std::size_t utf8_mark(std::span<const std::uint8_t> bytes);

}  // namespace strata::mesh
