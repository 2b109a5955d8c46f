#include "protocol/parse.h"

#include "protocol/json_values.h"

namespace strata::protocol {
namespace {

constexpr std::size_t kMaxRef = 64;

// Replaces invalid UTF-8, for example in a file name, because JSON cannot contain it.
std::string dump(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

template <class Message, class SchemaOf>
Result<Message> parse_message(std::string_view text, std::string* ref, const JsonLimits& limits,
                              SchemaOf&& schema_of_op) {
  auto json = STRATA_TRY(parse_json(text, limits));
  if (!json.is_object())
    return fail(ErrorCode::invalid, "Not a message",
                "A message is an object with the member \"op\".");
  if (auto id = json.find("id"); ref != nullptr && id != json.end() && id->is_string())
    *ref = id->template get_ref<const std::string&>().substr(0, kMaxRef);
  const auto op = json.find("op");
  if (op == json.end())
    return fail(ErrorCode::invalid, "Member missing", "A message names what it is in \"op\".",
                "op");
  if (!op->is_string()) return fail(ErrorCode::invalid, "Wrong type", "\"op\" is a text.", "op");
  const auto& word = op->template get_ref<const std::string&>();
  const std::optional<Schema> schema = schema_of_op(word);
  if (!schema)
    return fail(ErrorCode::invalid, "Unknown message",
                "There is no message \"" + word.substr(0, 50) + "\".", "op");
  STRATA_TRY(validate(*schema, json));
  Message message;
  read(json, message);
  STRATA_TRY(check_alternative(message, {}));
  return message;
}

}  // namespace

Result<ClientMessage> parse_client_message(std::string_view text, std::string* ref,
                                           const JsonLimits& limits) {
  return parse_message<ClientMessage>(text, ref, limits, client_message_schema);
}

Result<ServerMessage> parse_server_message(std::string_view text, const JsonLimits& limits) {
  return parse_message<ServerMessage>(text, nullptr, limits, server_message_schema);
}

std::string to_text(const ClientMessage& message) { return dump(to_json(message)); }
std::string to_text(const ServerMessage& message) { return dump(to_json(message)); }

std::string to_ref(const LayerRef& layer) {
  if (const auto* id = std::get_if<std::int64_t>(&layer)) return std::to_string(*id);
  return std::get<std::string>(layer);
}

}  // namespace strata::protocol
