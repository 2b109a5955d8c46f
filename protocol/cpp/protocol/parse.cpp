#include "protocol/parse.h"

#include <algorithm>

#include "core/utf8.h"
#include "protocol/json_values.h"

namespace strata::protocol {
namespace {

constexpr std::size_t kMaxRef = 64;

// Only what a JSON text can carry goes out: invalid UTF-8 (of a file name, say) is replaced.
std::string dump(const nlohmann::json& json) {
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// What somebody sent may stand in a problem, and may be long; a problem has its bounds all the same
// (Problem in http.schema.json).
constexpr std::size_t kMaxTitle = 200, kMaxDetail = 10'000, kMaxField = 500;
constexpr std::string_view kMore = "…";

std::string bounded(const std::string& text, std::size_t most) {
  if (text.size() <= most) return text;
  return std::string(first_bytes(text, most - kMore.size())).append(kMore);
}

template <class Message, class SchemaOf>
Result<Message> parse_message(std::string_view text, std::string* ref, const JsonLimits& limits,
                              SchemaOf&& schema_of_op) {
  auto json = parse_json(text, limits);
  if (!json) return tl::unexpected<Problem>(json.error());
  if (!json->is_object())
    return fail(422, "Not a message", "A message is an object with the member \"op\".");
  if (auto id = json->find("id"); ref != nullptr && id != json->end() && id->is_string())
    *ref = id->template get_ref<const std::string&>().substr(0, kMaxRef);
  const auto op = json->find("op");
  if (op == json->end())
    return fail(422, "Member missing", "A message names what it is in \"op\".", "op");
  if (!op->is_string()) return fail(422, "Wrong type", "\"op\" is a text.", "op");
  const auto& word = op->template get_ref<const std::string&>();
  const std::optional<Schema> schema = schema_of_op(word);
  if (!schema)
    return fail(422, "Unknown message", "There is no message \"" + word.substr(0, 50) + "\".",
                "op");
  if (auto ok = validate(*schema, *json); !ok) return tl::unexpected<Problem>(ok.error());
  Message message;
  read(*json, message);
  if (auto ok = check_alternative(message, {}); !ok) return tl::unexpected<Problem>(ok.error());
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

ProblemMessage problem_message(const Problem& problem, const std::optional<std::string>& ref) {
  ProblemMessage message;
  if (ref && !ref->empty()) message.ref = ref->substr(0, kMaxRef);
  message.title = bounded(problem.title, kMaxTitle);
  message.status = std::clamp(problem.status, 400, 599);
  message.detail = bounded(problem.detail, kMaxDetail);
  if (!problem.field.empty()) message.field = bounded(problem.field, kMaxField);
  if (problem.offset) message.offset = static_cast<int>(*problem.offset);
  return message;
}

nlohmann::json problem_body(const Problem& problem) {
  nlohmann::json json{{"type", "about:blank"},
                      {"title", bounded(problem.title, kMaxTitle)},
                      {"status", problem.status},
                      {"detail", bounded(problem.detail, kMaxDetail)}};
  if (!problem.field.empty()) json["field"] = bounded(problem.field, kMaxField);
  if (problem.offset) json["offset"] = *problem.offset;
  return json;
}

std::string to_ref(const LayerRef& layer) {
  if (const auto* id = std::get_if<std::int64_t>(&layer)) return std::to_string(*id);
  return std::get<std::string>(layer);
}

}  // namespace strata::protocol
