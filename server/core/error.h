#pragma once

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

namespace strata {

// The kind of a failure. Callers decide by it; title and detail are for people and may change at
// any time. The names are stable: HTTP has them in the `type` of a problem
// (docs/reference/errors.md).
enum class ErrorCode {
  // The caller can act on these.
  malformed,            // the request cannot be read: its syntax, its parameters
  unauthenticated,      // nobody is signed in, or the secret is not valid
  forbidden,            // this person may not do it
  not_found,            // it does not exist, or this person may not know that it does
  method_not_allowed,   // the address has other methods
  not_acceptable,       // no representation that the client accepts
  too_slow,             // the client sends its body too slowly
  conflict,             // the state of the data does not allow it
  superseded,           // a newer request took the place of this one
  gone,                 // it was deleted while this caller held it
  stale,                // somebody else changed it since it was read
  too_large,            // more bytes or entries than the server takes
  unsupported,          // a format that the server does not read or write
  range_not_satisfied,  // the file ends before the range of bytes
  misdirected,          // the request names a host that the server does not have
  invalid,              // a value that can be read but is not allowed
  upgrade_required,     // the address speaks WebSocket only
  version_required,     // the project demands If-Match
  too_many_requests,    // this caller sends more than its share
  head_too_large,       // the head of the request is too long
  cancelled,            // the caller took the request back
  // The state of the server; the same call may succeed later.
  internal,         // a mistake in the server or damaged data
  not_implemented,  // a part of HTTP that the server does not have
  bad_gateway,      // another program answered something that is not understood
  busy,             // too much work waits
  unavailable,      // the database or the GPU cannot be reached, or the server stops
  timed_out,        // it takes longer than it may
  gpu_lost,         // the graphics context is being restored
  out_of_memory,    // a budget of main or GPU memory is used up
  storage_full,     // the disk is full
};
constexpr ErrorCode kLastErrorCode = ErrorCode::storage_full;

std::string_view name(ErrorCode code);
std::optional<ErrorCode> error_code_named(std::string_view name);
// Whether the server failed, and not the caller.
constexpr bool is_server_failure(ErrorCode code) { return code >= ErrorCode::internal; }
std::ostream& operator<<(std::ostream& out, ErrorCode code);

// A failure, in words that say what to do about it. Over HTTP it becomes an
// `application/problem+json` (RFC 9457), over the WebSocket a `problem` message.
struct Error {
  ErrorCode code = ErrorCode::malformed;
  std::string title;    // short, and the same for each failure of a kind: "Value out of range"
  std::string detail;   // this failure, and what to do about it
  std::string field{};  // JSON pointer-like path of the offending field, empty when none
  // where the field is a text in a language: characters before the mistake
  std::optional<std::size_t> offset{};
};

// Bad client or file data is an expected result, not an exception.
template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string title, std::string detail,
                                  std::string field = {}) {
  return tl::unexpected<Error>(Error{code, std::move(title), std::move(detail), std::move(field)});
}

namespace detail {
template <class Expected>
auto value_of(Expected&& result) {
  if constexpr (!std::is_void_v<typename std::remove_cvref_t<Expected>::value_type>)
    return *std::forward<Expected>(result);
}
}  // namespace detail

}  // namespace strata

// The value of a Result. Where it is an error, the enclosing function returns that error:
//   const Layer layer = STRATA_TRY(room.layer(ref));
//   STRATA_TRY(check_name(layer.name));
// Use it as a statement or as a whole initialiser, outside coroutines. (A statement expression of
// GCC and Clang.)
#define STRATA_TRY(...) STRATA_TRY_NAMED_(__COUNTER__, __VA_ARGS__)
#define STRATA_TRY_NAMED_(number, ...) STRATA_TRY_AS_(number, __VA_ARGS__)
#define STRATA_TRY_AS_(number, ...)                                                        \
  ({                                                                                       \
    auto&& strata_result_##number = (__VA_ARGS__);                                         \
    if (!strata_result_##number)                                                           \
      return tl::unexpected(                                                               \
          std::forward<decltype(strata_result_##number)>(strata_result_##number).error()); \
    ::strata::detail::value_of(                                                            \
        std::forward<decltype(strata_result_##number)>(strata_result_##number));           \
  })
