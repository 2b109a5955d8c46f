#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace strata::net {

struct ByteRange {
  std::uint64_t begin = 0, end = 0;  // excluding `end`
};

// The range that a Range header requests from a content of `bytes` bytes (RFC 9110, 14.2). For
// other units, several ranges and malformed ranges, `requested_range` returns the whole content, as
// the RFC allows. It returns nothing if no requested byte exists (416).
struct RequestedRange {
  ByteRange range;
  bool is_part = false;
};
std::optional<RequestedRange> requested_range(std::string_view header, std::uint64_t bytes);

}  // namespace strata::net
