#pragma once

#include <cstddef>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>
#include <vector>

namespace strata {

// The kind of a failure. Programs can depend on it; title and detail are for people and may change
// at any time. The names are stable: HTTP has them in the `type` of a problem
// (docs/reference/errors.md).
enum class ErrorCode {
  // The caller can act on these.
  malformed,            // the syntax or parameters of the request are invalid
  unauthenticated,      // no one is signed in, or the secret is not valid
  forbidden,            // the caller's role does not allow it
  not_found,            // it does not exist, or is not visible to the caller
  method_not_allowed,   // the address has other methods
  not_acceptable,       // no representation that the client accepts
  too_slow,             // the client sends its body too slowly
  conflict,             // the state of the data does not allow it
  superseded,           // a newer request replaced this one
  gone,                 // it was deleted while the caller used it
  stale,                // it changed since the caller read it
  too_large,            // more bytes or entries than the server accepts
  unsupported,          // a format that the server does not read or write
  range_not_satisfied,  // the file ends before the range of bytes
  misdirected,          // the request names a host that is not this server
  invalid,              // a value of valid syntax that is not allowed
  upgrade_required,     // the address supports WebSocket only
  version_required,     // the project requires If-Match
  too_many_requests,    // the caller exceeds its share of requests
  head_too_large,       // the head of the request is too long
  cancelled,            // the caller canceled the request
  // The state of the server; the same call may succeed later.
  internal,         // a mistake in the server or damaged data
  not_implemented,  // a part of HTTP that the server does not have
  bad_gateway,      // the answer of another program is invalid
  busy,             // too much work is queued
  unavailable,      // the database or GPU is unreachable, or the server stops
  timed_out,        // it exceeds its time limit
  gpu_lost,         // the graphics context is being restored
  out_of_memory,    // a budget of main or GPU memory is used up
  storage_full,     // the disk is full
};
constexpr ErrorCode kLastErrorCode = ErrorCode::storage_full;

std::string_view name(ErrorCode code);
std::optional<ErrorCode> error_code_named(std::string_view name);
// Whether the server caused the failure.
constexpr bool is_server_failure(ErrorCode code) { return code >= ErrorCode::internal; }
std::ostream& operator<<(std::ostream& out, ErrorCode code);

// A failure, with a text that includes the remedy. HTTP sends it as `application/problem+json`
// (RFC 9457), the WebSocket as a `problem` message.
struct Error {
  ErrorCode code = ErrorCode::malformed;
  std::string title;    // short and fixed for a kind of failure: "Value out of range"
  std::string detail;   // this failure and its remedy
  std::string field{};  // JSON pointer-like path of the offending field; may be empty
  // for a field that is a text in a language (expression/expression.h): the characters before the
  // mistake, the number of wrong characters if it is known, texts that would correct them (the most
  // likely one first), and the stable name of the kind of mistake
  std::optional<std::size_t> offset{};
  std::size_t length = 0;
  std::vector<std::string> suggestions{};
  std::string_view reason{};
};

// Bad data of clients or files are an expected result, not an exception.
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

// Returns the value of a Result. If it is an error, the enclosing function returns that error:
//   const Layer layer = STRATA_TRY(room.layer(ref));
//   STRATA_TRY(check_name(layer.name));
// Use it as a statement or a whole initializer, outside coroutines. (A statement expression of GCC
// and Clang.)
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
