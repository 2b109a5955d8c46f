#include "room/presence_message.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "protocol/parse.h"
#include "store/nodes/presence_channel.h"

namespace strata::room {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxBytes = store::PresenceChannel::kMaxBytes;
constexpr int kMaxDepth = 8;  // of the JSON; the numbers of a camera are at depth 5

protocol::PresenceUser to_user(const Presence& person) {
  protocol::PresenceUser user;
  user.session = person.session;
  user.name = person.user;
  if (!person.full_name.empty()) user.full_name = person.full_name;
  user.color = person.color;
  if (person.pointer) {
    auto& pointer = user.pointer.emplace();
    pointer.position = person.pointer->position;
    pointer.radius = person.pointer->radius;
  }
  user.leading = person.leading;
  user.following = person.following;
  user.camera = person.camera;
  return user;
}

Presence to_presence(protocol::PresenceUser user) {
  Presence person;
  person.session = user.session;
  person.user = std::move(user.name);
  person.full_name = std::move(user.full_name).value_or("");
  person.color = std::move(user.color);
  if (user.pointer) person.pointer = Pointing{user.pointer->position, user.pointer->radius};
  person.leading = user.leading;
  person.following = user.following;
  person.camera = std::move(user.camera);
  return person;
}

void keep_only(json& value, std::initializer_list<std::string_view> known) {
  if (!value.is_object()) return;
  for (auto member = value.begin(); member != value.end();)
    member = std::ranges::find(known, member.key()) == known.end() ? value.erase(member)
                                                                   : std::next(member);
}

// Removes the members that `to_presence` does not read, because a newer version may send more.
void remove_unknown(json& person) {
  keep_only(person,
            {"session", "name", "full_name", "color", "pointer", "leading", "following", "camera"});
  if (const auto pointer = person.find("pointer"); pointer != person.end())
    keep_only(*pointer, {"position", "radius"});
  if (const auto camera = person.find("camera"); camera != person.end())
    keep_only(*camera, {"view", "projection", "width", "height"});
}

// The JSON of one part. `users` is the content of the list.
std::string text_of(const Uuid& node, ModelId model, std::size_t part, std::size_t parts,
                    const std::string& users) {
  return R"({"node":")" + to_string(node) + R"(","model":)" + to_string(model) + R"(,"part":)" +
         std::to_string(part) + R"(,"parts":)" + std::to_string(parts) + R"(,"users":[)" + users +
         "]}";
}

tl::unexpected<Error> malformed(const std::string& member) {
  return fail(ErrorCode::malformed, "Invalid message of a node",
              "`" + member + "` is missing or invalid.", member);
}

// Returns nothing if the member is missing, is not an integer, or is outside the limits.
std::optional<std::int64_t> integer(const json& message, const char* member, std::int64_t least,
                                    std::int64_t most) {
  const auto found = message.find(member);
  if (found == message.end() || !found->is_number_integer()) return std::nullopt;
  // The library converts larger numbers to negative ones.
  if (found->is_number_unsigned() &&
      found->get<std::uint64_t>() > std::uint64_t{std::numeric_limits<std::int64_t>::max()})
    return std::nullopt;
  const auto value = found->get<std::int64_t>();
  if (value < least || value > most) return std::nullopt;
  return value;
}

std::optional<Uuid> node_of(const json& message) {
  const auto found = message.find("node");
  if (found == message.end() || !found->is_string()) return std::nullopt;
  return parse_uuid(found->get_ref<const std::string&>());
}

}  // namespace

std::vector<std::string> presence_texts(const Uuid& node, ModelId model,
                                        std::span<const Presence> people) {
  const std::size_t most =
      kMaxBytes - text_of(node, model, kMaxPresenceParts, kMaxPresenceParts, "").size();
  std::vector<std::string> lists(1);
  for (const Presence& person : people) {
    const std::string user = to_json(to_user(person)).dump();
    if (user.size() > most) continue;
    if (!lists.back().empty() && lists.back().size() + 1 + user.size() > most) {
      if (lists.size() == kMaxPresenceParts) break;
      lists.emplace_back();
    }
    if (!lists.back().empty()) lists.back() += ',';
    lists.back() += user;
  }
  std::vector<std::string> texts;
  for (const std::string& users : lists)
    texts.push_back(text_of(node, model, texts.size(), lists.size(), users));
  return texts;
}

Result<PresenceMessage> parse_presence(std::string_view text) {
  auto content = STRATA_TRY(protocol::parse_json(text, {kMaxBytes, kMaxDepth}));
  if (!content.is_object()) return malformed("node");
  const auto node = node_of(content);
  if (!node) return malformed("node");
  const auto model = integer(content, "model", 1, std::numeric_limits<std::int64_t>::max());
  if (!model) return malformed("model");
  const auto parts = integer(content, "parts", 1, kMaxPresenceParts);
  if (!parts) return malformed("parts");
  const auto part = integer(content, "part", 0, *parts - 1);
  if (!part) return malformed("part");
  const auto users = content.find("users");
  if (users == content.end() || !users->is_array()) return malformed("users");
  PresenceMessage message{
      *node, ModelId(*model), static_cast<int>(*part), static_cast<int>(*parts), {}};
  for (json& each : *users) {
    remove_unknown(each);
    auto user = STRATA_TRY(protocol::from_json<protocol::PresenceUser>(each, "users"));
    message.people.push_back(to_presence(std::move(user)));
  }
  return message;
}

}  // namespace strata::room
