#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/messages.h"
#include "protocol/strict_json.h"
#include "protocol/validate.h"

// Converts external text to a value, or to an error that names the field. Thread-safe.
namespace strata::protocol {

// Converts JSON that is already parsed, for example a part of a larger object. `field` is the path
// of this part.
template <class T>
Result<T> from_json(const nlohmann::json& json, const std::string& field = {}) {
  STRATA_TRY(validate(kSchemaOf<T>, json, field));
  T value;
  read(json, value);
  if constexpr (requires { check(value, field); }) STRATA_TRY(check(value, field));
  return value;
}

// Parses the body of an HTTP request.
template <class T>
Result<T> parse(std::string_view text, const JsonLimits& limits = {}) {
  JsonLimits bounded = limits;
  bounded.lists = &list_limits(kSchemaOf<T>);
  auto json = STRATA_TRY(parse_json(text, bounded));
  return from_json<T>(json);
}

// Parses a text message of the WebSocket. If `ref` is not null, sets it to the message's `id` if
// this is readable. A refused message also sets it, so the `problem` can contain the id.
Result<ClientMessage> parse_client_message(std::string_view text, std::string* ref = nullptr,
                                           const JsonLimits& limits = {});
Result<ServerMessage> parse_server_message(std::string_view text,
                                           const JsonLimits& limits = {16 * 1024 * 1024, 32});

// Return the message as one line of JSON.
std::string to_text(const ClientMessage& message);
std::string to_text(const ServerMessage& message);

// Returns a reference such as "12" or "cracks", which the store and the routes accept.
std::string to_ref(const LayerRef& layer);

}  // namespace strata::protocol
