#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "protocol/messages.h"

// Converts errors to HTTP status codes and problems (RFC 9457). Only `net` uses these functions.
namespace strata::protocol {

struct ProblemKind {
  ErrorCode code;
  int status;                // HTTP status code
  std::string_view meaning;  // one sentence
  std::string_view remedy;   // advice for a client
};
// Returns all kinds, in the order of ErrorCode.
std::span<const ProblemKind> problem_kinds();

int http_status(ErrorCode code);
// Returns a URI reference on this server, such as "/problems#stale". The page /problems describes
// all types.
std::string problem_type(ErrorCode code);
// Returns the code for such a reference. Returns nothing for other references.
std::optional<ErrorCode> code_of_problem_type(std::string_view type);
// Returns the code for a response without a `type`, from a release before 0.2 or from a proxy.
ErrorCode code_of_http_status(int status);

// Returns the body of an `application/problem+json` response. It may contain text from a client, so
// texts are cut to the limits of the API.
nlohmann::json problem_body(const Error& error);
// Returns the problem as a WebSocket message. `ref` is the `id` of the refused message.
ProblemMessage problem_message(const Error& error, const std::optional<std::string>& ref = {});

}  // namespace strata::protocol
