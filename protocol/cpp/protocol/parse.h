#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "protocol/messages.h"
#include "protocol/strict_json.h"
#include "protocol/validate.h"

// The boundary: text from outside becomes a value, or an Error that names the field. Thread-safe.
namespace strata::protocol {

// From JSON already parsed (for example a part of a larger object); `field` is where it stands.
template <class T>
Result<T> from_json(const nlohmann::json& json, const std::string& field = {}) {
  STRATA_TRY(validate(kSchemaOf<T>, json, field));
  T value;
  read(json, value);
  if constexpr (requires { check(value, field); }) STRATA_TRY(check(value, field));
  return value;
}

// The body of an HTTP request.
template <class T>
Result<T> parse(std::string_view text, const JsonLimits& limits = {}) {
  JsonLimits bounded = limits;
  bounded.lists = &list_limits(kSchemaOf<T>);
  auto json = STRATA_TRY(parse_json(text, bounded));
  return from_json<T>(json);
}

// A text message of the WebSocket. `ref`, when given, becomes the message's `id` as far as it can
// be read, also when the message is refused, so that the `problem` can name it.
Result<ClientMessage> parse_client_message(std::string_view text, std::string* ref = nullptr,
                                           const JsonLimits& limits = {});
Result<ServerMessage> parse_server_message(std::string_view text,
                                           const JsonLimits& limits = {16 * 1024 * 1024, 32});

// One line of JSON, ready to send.
std::string to_text(const ClientMessage& message);
std::string to_text(const ServerMessage& message);

// "12" or "cracks": what the store and the routes take.
std::string to_ref(const LayerRef& layer);

}  // namespace strata::protocol
