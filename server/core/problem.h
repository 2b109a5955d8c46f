#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace strata {

// What a caller did wrong, or what the server cannot do, told so that the caller can act on it.
// Becomes RFC 9457 `application/problem+json` over HTTP and the `problem` message over the
// WebSocket.
struct Problem {
  int status = 400;  // HTTP status code; 499 is "cancelled by the caller"
  // short and constant for a kind of problem: "Value out of range"
  std::string title;
  std::string detail;  // this occurrence, and what to do about it
  // JSON pointer-like path of the offending field, empty when none
  std::string field;
  // where the field is a text that is read: characters before what is wrong
  std::optional<std::size_t> offset{};
};

// Bad client or file data is an expected result, not an exception.
template <class T>
using Result = tl::expected<T, Problem>;

inline tl::unexpected<Problem> fail(int status, std::string title, std::string detail,
                                    std::string field = {}) {
  return tl::unexpected<Problem>(
      Problem{status, std::move(title), std::move(detail), std::move(field)});
}

}  // namespace strata
