#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace strata::net {

struct ByteRange {
  std::uint64_t begin = 0, end = 0;  // excludes `end`
};

// The range of a content of `size` bytes that a Range header requests (RFC 9110, 14.2). Ranges of
// other units, several ranges and malformed ones are ignored, as the RFC allows: the result is the
// whole content. Nothing: no requested byte exists (416).
struct RequestedRange {
  ByteRange range;
  bool is_part = false;
};
std::optional<RequestedRange> requested_range(std::string_view header, std::uint64_t bytes);

}  // namespace strata::net
