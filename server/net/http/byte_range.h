#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace strata::net {

struct ByteRange {
  std::uint64_t begin = 0, end = 0;  // before `end`
};

// What a Range header asks of a content of so many bytes (RFC 9110, 14.2). Ranges of other units,
// several at once and malformed ones are passed over, as the RFC allows: then it is all of it.
// Nothing: no byte of it is there (416).
struct AskedRange {
  ByteRange range;
  bool is_part = false;
};
std::optional<AskedRange> asked_range(std::string_view header, std::uint64_t bytes);

}  // namespace strata::net
