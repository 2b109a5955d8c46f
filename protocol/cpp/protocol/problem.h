#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "protocol/messages.h"

// Converts errors to HTTP status codes and problems (RFC 9457). Only `net` uses these.
namespace strata::protocol {

struct ProblemKind {
  ErrorCode code;
  int status;                // of HTTP
  std::string_view meaning;  // one sentence
  std::string_view remedy;   // advice for a client
};
// Returns all kinds, in the order of ErrorCode.
std::span<const ProblemKind> problem_kinds();

int http_status(ErrorCode code);
// Returns a URI reference on this server: "/problems#stale". The page /problems describes each.
std::string problem_type(ErrorCode code);
// Reads such a reference; nothing for another reference.
std::optional<ErrorCode> code_of_problem_type(std::string_view type);
// For an answer without a `type`, from a release before 0.2 or from a proxy.
ErrorCode code_of_http_status(int status);

// Returns the body of an `application/problem+json` answer. It may contain text that a client sent:
// texts are cut to the limits of the contract.
nlohmann::json problem_body(const Error& error);
// The same for the WebSocket; `ref` is the `id` of the refused message.
ProblemMessage problem_message(const Error& error, const std::optional<std::string>& ref = {});

}  // namespace strata::protocol
