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

// The kind of a failure. Programs can depend on the kind and its name. The title and detail are for
// users and may change at any time. HTTP sends the name in the `type` of a problem
// (docs/reference/errors.md).
enum class ErrorCode {
  // Failures that the caller can correct.
  malformed,            // the syntax or parameters of the request are invalid
  unauthenticated,      // the user is not signed in, or the secret is not valid
  forbidden,            // the role of the caller does not allow the request
  not_found,            // the entity does not exist, or the caller cannot see it
  method_not_allowed,   // the address supports other methods only
  not_acceptable,       // the client accepts none of the available formats
  too_slow,             // the client sends its body too slowly
  conflict,             // the state of the data does not allow the request
  superseded,           // a newer request replaced this one
  gone,                 // the entity was deleted while the caller used it
  stale,                // the entity has changed since the caller read it
  too_large,            // more bytes or entries than the server accepts
  unsupported,          // a format that the server does not read or write
  range_not_satisfied,  // the requested range of bytes begins after the end of the file
  misdirected,          // the request names a host that is not this server
  invalid,              // the value has a valid syntax, but is not allowed
  upgrade_required,     // the address supports WebSocket only
  version_required,     // the project requires If-Match
  too_many_requests,    // the caller sent more requests than the server allows
  head_too_large,       // the head of the request is too long
  cancelled,            // the caller canceled the request
  moved,                // another node of the site owns the model
  // Failures of the server. The same request may succeed later.
  internal,         // an error in the program, or damaged data
  damaged,          // a stored file is missing, or its content has changed
  not_implemented,  // a part of HTTP that the server does not support
  bad_gateway,      // the response of another program is invalid
  busy,             // too much work is in the queue
  unavailable,      // the database or GPU is unreachable, or the server is stopping
  timed_out,        // the work exceeded its time limit
  gpu_lost,         // the graphics context is being restored
  out_of_memory,    // the budget of main memory or GPU memory is used up
  storage_full,     // the disk is full
};
constexpr ErrorCode kLastErrorCode = ErrorCode::storage_full;

std::string_view name(ErrorCode code);
std::optional<ErrorCode> error_code_named(std::string_view name);
// Returns whether the server caused the failure.
constexpr bool is_server_failure(ErrorCode code) { return code >= ErrorCode::internal; }
std::ostream& operator<<(std::ostream& out, ErrorCode code);

// A failure, with a text that says what to do. HTTP sends it as `application/problem+json` (RFC
// 9457), and the WebSocket as a `problem` message.
struct Error {
  ErrorCode code = ErrorCode::malformed;
  std::string title;    // short, the same for all failures of this kind: "Value out of range"
  std::string detail;   // describes this failure, and what to do
  std::string field{};  // path of the invalid field, like a JSON pointer; may be empty
  // These members describe a mistake in a text in a formal language (expression/expression.h). They
  // are the number of characters before the mistake, the number of wrong characters if known,
  // corrections (the most likely one first), and the stable name of the kind of mistake.
  std::optional<std::size_t> offset{};
  std::size_t length = 0;
  std::vector<std::string> suggestions{};
  std::string_view reason{};
  // For `moved`: the address of the node that owns the model. Empty if this node is unknown. The
  // request can then be repeated at the address of the site.
  std::string location{};
};

// Invalid data from clients or files is an expected result, not an exception.
template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(ErrorCode code, std::string title, std::string detail,
                                  std::string field = {}) {
  return tl::unexpected<Error>(Error{code, std::move(title), std::move(detail), std::move(field)});
}

// Returns the error for a model that another node of the site owns (store/nodes/nodes.h).
Error moved_to(std::string location);

namespace detail {
template <class Expected>
auto value_of(Expected&& result) {
  if constexpr (!std::is_void_v<typename std::remove_cvref_t<Expected>::value_type>)
    return *std::forward<Expected>(result);
}
}  // namespace detail

}  // namespace strata

// Returns the value of a Result. If the Result is an error, the enclosing function returns that
// error:
//   const Layer layer = STRATA_TRY(room.layer(ref));
//   STRATA_TRY(check_name(layer.name));
// Use it as a statement or as a whole initializer, and not in a coroutine. (It is a statement
// expression of GCC and Clang.)
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
