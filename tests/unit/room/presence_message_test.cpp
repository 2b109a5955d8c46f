#include "room/presence_message.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "store/nodes/presence_channel.h"

namespace strata::room {
namespace {

using nlohmann::json;

const Uuid kNode = *parse_uuid("6f9619ff-8b86-4d01-b42d-00cf4fc964ff");
const ModelId kModel(12);

Presence person(const std::string& user) {
  Presence made;
  made.session = random_uuid();
  made.user = user;
  made.color = "#d55e00";
  return made;
}

Camera camera() {
  Camera made;
  made.width = 1280;
  made.height = 720;
  return made;
}

// A message as another node sends it, with these members instead of its own. `null` removes one.
std::string text_with(const json& members) {
  json message = json::parse(presence_texts(kNode, kModel, std::vector{person("ada")}).front());
  message.merge_patch(members);
  return message.dump();
}

TEST(PresenceMessage, a_list_arrives_as_it_was_sent) {
  Presence ada = person("ada");
  ada.full_name = "Ada Lovelace";
  ada.pointer = Pointing{{1.5, -2, 88}, 0.25};
  ada.leading = true;
  ada.camera = camera();
  Presence bob = person("bob");
  bob.pointer = Pointing{{0, 0, 1}, {}};
  bob.following = ada.session;
  const auto texts = presence_texts(kNode, kModel, std::vector{ada, bob});
  ASSERT_EQ(texts.size(), 1u);
  const auto message = parse_presence(texts.front());
  ASSERT_TRUE(message) << message.error().detail;
  EXPECT_EQ(message->node, kNode);
  EXPECT_EQ(message->model, kModel);
  EXPECT_EQ(message->part, 0);
  EXPECT_EQ(message->parts, 1);
  ASSERT_EQ(message->people.size(), 2u);
  const Presence &first = message->people[0], &second = message->people[1];
  EXPECT_EQ(first.session, ada.session);
  EXPECT_EQ(first.user, "ada");
  EXPECT_EQ(first.full_name, "Ada Lovelace");
  EXPECT_EQ(first.color, "#d55e00");
  ASSERT_TRUE(first.pointer);
  EXPECT_EQ(first.pointer->position, ada.pointer->position);
  EXPECT_EQ(first.pointer->radius, 0.25);
  EXPECT_TRUE(first.leading);
  EXPECT_EQ(first.camera, ada.camera);
  EXPECT_EQ(second.full_name, "");
  ASSERT_TRUE(second.pointer);
  EXPECT_FALSE(second.pointer->radius);
  EXPECT_FALSE(second.leading);
  EXPECT_EQ(second.following, ada.session);
  EXPECT_FALSE(second.camera);
}

TEST(PresenceMessage, an_empty_list_is_one_text) {
  const auto texts = presence_texts(kNode, kModel, {});
  ASSERT_EQ(texts.size(), 1u);
  const auto message = parse_presence(texts.front());
  ASSERT_TRUE(message) << message.error().detail;
  EXPECT_TRUE(message->people.empty());
}

TEST(PresenceMessage, a_long_list_has_several_parts_in_order) {
  std::vector<Presence> people;
  for (int i = 0; i < 100; ++i) {
    people.push_back(person("user" + std::to_string(i)));
    if (i % 10 == 0) people.back().camera = camera();
  }
  const auto texts = presence_texts(kNode, kModel, people);
  ASSERT_GT(texts.size(), 1u);
  std::vector<Presence> received;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_LE(texts[i].size(), store::PresenceChannel::kMaxBytes);
    const auto message = parse_presence(texts[i]);
    ASSERT_TRUE(message) << message.error().detail;
    EXPECT_EQ(message->part, static_cast<int>(i));
    EXPECT_EQ(message->parts, static_cast<int>(texts.size()));
    received.insert(received.end(), message->people.begin(), message->people.end());
  }
  ASSERT_EQ(received.size(), people.size());
  for (std::size_t i = 0; i < people.size(); ++i) EXPECT_EQ(received[i].session, people[i].session);
}

TEST(PresenceMessage, the_length_of_a_list_is_limited) {
  const auto texts = presence_texts(kNode, kModel, std::vector(5000, person("ada")));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kMaxPresenceParts));
  for (const auto& text : texts) EXPECT_TRUE(parse_presence(text));
}

TEST(PresenceMessage, the_longest_names_fit) {
  Presence ada = person(std::string(200, '\x01'));  // six characters each in JSON
  ada.full_name = std::string(200, '\x01');
  ada.camera = camera();
  const auto texts = presence_texts(kNode, kModel, std::vector{ada, ada, ada});
  std::size_t received = 0;
  for (const auto& text : texts) received += parse_presence(text).value().people.size();
  EXPECT_EQ(received, 3u);
}

TEST(PresenceMessage, members_of_newer_versions_are_ignored) {
  Presence ada = person("ada");
  ada.pointer = Pointing{{1, 2, 3}, 0.5};
  ada.camera = camera();
  json message = json::parse(presence_texts(kNode, kModel, {&ada, 1}).front());
  message["load"] = 0.5;
  json& user = message["users"][0];
  user["mood"] = {{"happy", true}};
  user["pointer"]["normal"] = {0, 0, 1};
  user["camera"]["lens"] = "wide";
  const auto parsed = parse_presence(message.dump());
  ASSERT_TRUE(parsed) << parsed.error().detail;
  ASSERT_EQ(parsed->people.size(), 1u);
  EXPECT_EQ(parsed->people[0].user, "ada");
  EXPECT_EQ(parsed->people[0].pointer->radius, 0.5);
  EXPECT_EQ(parsed->people[0].camera, ada.camera);
}

TEST(PresenceMessage, other_texts_are_refused) {
  ASSERT_TRUE(parse_presence(text_with(json::object())));
  const json user = json::parse(text_with(json::object()))["users"][0];
  const auto users_with = [&](const json& members) {
    json changed = user;
    changed.merge_patch(members);
    return text_with({{"users", {user, changed}}});
  };
  const std::string texts[] = {
      "",
      "not JSON",
      "[]",
      "7",
      text_with({{"node", nullptr}}),
      text_with({{"node", 5}}),
      text_with({{"node", "a"}}),
      text_with({{"model", nullptr}}),
      text_with({{"model", 0}}),
      text_with({{"model", -3}}),
      text_with({{"model", 1.5}}),
      text_with({{"model", 18446744073709551615u}}),
      text_with({{"parts", 0}}),
      text_with({{"parts", kMaxPresenceParts + 1}}),
      text_with({{"part", 1}}),
      text_with({{"part", -1}}),
      text_with({{"users", nullptr}}),
      text_with({{"users", {{"session", "a"}}}}),
      text_with({{"users", {7}}}),
      users_with({{"session", "a"}}),
      users_with({{"name", ""}}),
      users_with({{"color", "red"}}),
      users_with({{"pointer", {1, 2, 3}}}),
      users_with({{"camera", json::object()}}),
      users_with({{"pointer", {{"radius", 1}}}}),
      users_with({{"following", 1}}),
      text_with(json::object()) + " x",
      std::string(store::PresenceChannel::kMaxBytes + 1, ' '),
  };
  for (const std::string& text : texts) EXPECT_FALSE(parse_presence(text)) << text;
  const std::string whole = text_with(json::object());
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_FALSE(parse_presence(whole.substr(0, length))) << length;
}

}  // namespace
}  // namespace strata::room
