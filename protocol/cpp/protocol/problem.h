#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "protocol/messages.h"

// How errors become HTTP status codes and problems (RFC 9457). Nothing below `net` knows these.
namespace strata::protocol {

struct ProblemKind {
  ErrorCode code;
  int status;                // of HTTP
  std::string_view meaning;  // one sentence
  std::string_view remedy;   // what a client can do
};
// All of them, in the order of ErrorCode.
std::span<const ProblemKind> problem_kinds();

int http_status(ErrorCode code);
// A URI reference on this server: "/problems#stale". The page /problems describes each.
std::string problem_type(ErrorCode code);
// Reads the above; nothing where it is another reference.
std::optional<ErrorCode> code_of_problem_type(std::string_view type);
// For an answer without a `type`, of a release before 0.2 or of a proxy.
ErrorCode code_of_http_status(int status);

// The body of an `application/problem+json` answer. What somebody sent may be part of it: texts are
// cut to the bounds of the contract.
nlohmann::json problem_body(const Error& error);
// The same for the WebSocket; `ref` is the `id` of the refused message.
ProblemMessage problem_message(const Error& error, const std::optional<std::string>& ref = {});

}  // namespace strata::protocol
