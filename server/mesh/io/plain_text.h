#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace strata::mesh {

// The text of a file as the readers of text formats expect it: without a byte order mark. If the
// mark indicates UTF-16, the text is converted to UTF-8. Any other text is unchanged. The result is
// valid during the lifetime of this object and of `bytes`.
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

// Returns the size of a UTF-8 byte order mark at the beginning, 0 or 3.
std::size_t utf8_mark(std::span<const std::uint8_t> bytes);

}  // namespace strata::mesh
