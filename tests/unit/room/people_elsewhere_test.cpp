#include "room/open/people_elsewhere.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace strata::room {
namespace {

using testing::ElementsAre;
using testing::UnorderedElementsAre;

struct PeopleElsewhereTest : testing::Test {
  static Presence person(const Uuid& session, const std::string& user) {
    Presence made;
    made.session = session;
    made.user = user;
    return made;
  }
  std::vector<std::string> users() const {
    std::vector<std::string> names;
    people.each([&](const Presence& each) { names.push_back(each.user); });
    return names;
  }

  PeopleElsewhere people;
  const Uuid a = random_uuid(), b = random_uuid();  // nodes
  const Uuid ada = random_uuid(), bob = random_uuid(), cleo = random_uuid();
  const PeopleElsewhere::Clock::time_point start = PeopleElsewhere::Clock::now();
};

TEST_F(PeopleElsewhereTest, each_list_replaces_the_list_of_the_same_node) {
  EXPECT_TRUE(people.empty());
  EXPECT_TRUE(people.replace(a, {person(ada, "ada"), person(bob, "bob")}, start).any);
  EXPECT_TRUE(people.replace(b, {person(cleo, "cleo")}, start).any);
  EXPECT_THAT(users(), UnorderedElementsAre("ada", "bob", "cleo"));
  const auto change = people.replace(a, {person(bob, "bob")}, start);
  EXPECT_TRUE(change.any);
  EXPECT_THAT(change.left, ElementsAre(ada));
  EXPECT_THAT(users(), UnorderedElementsAre("bob", "cleo"));
  EXPECT_FALSE(people.has(ada));
  EXPECT_TRUE(people.has(cleo));
}

TEST_F(PeopleElsewhereTest, a_repeated_list_changes_nothing) {
  Presence pointing = person(ada, "ada");
  pointing.pointer = Pointing{{1, 2, 3}, 0.5};
  people.replace(a, {pointing}, start);
  EXPECT_FALSE(people.replace(a, {pointing}, start).any);
  pointing.pointer->position.x = 2;
  EXPECT_TRUE(people.replace(a, {pointing}, start).any);
  pointing.pointer->radius.reset();
  EXPECT_TRUE(people.replace(a, {pointing}, start).any);
  pointing.pointer.reset();
  EXPECT_TRUE(people.replace(a, {pointing}, start).any);
  pointing.leading = true;
  EXPECT_TRUE(people.replace(a, {pointing}, start).any);
  pointing.following = bob;
  EXPECT_TRUE(people.replace(a, {pointing}, start).any);
}

TEST_F(PeopleElsewhereTest, a_camera_is_a_change_of_one_session) {
  Presence seen = person(ada, "ada");
  people.replace(a, {seen, person(bob, "bob")}, start);
  seen.camera.emplace().width = 640;
  const auto change = people.replace(a, {seen, person(bob, "bob")}, start);
  EXPECT_FALSE(change.any);
  EXPECT_THAT(change.cameras, ElementsAre(ada));
}

TEST_F(PeopleElsewhereTest, an_empty_list_removes_the_node) {
  EXPECT_FALSE(people.replace(a, {}, start).any);
  people.replace(a, {person(ada, "ada")}, start);
  const auto change = people.replace(a, {}, start);
  EXPECT_TRUE(change.any);
  EXPECT_THAT(change.left, ElementsAre(ada));
  EXPECT_TRUE(people.empty());
}

TEST_F(PeopleElsewhereTest, a_silent_node_is_forgotten) {
  const auto limit = PeopleElsewhere::kSilentAfter;
  people.replace(a, {person(ada, "ada")}, start);
  people.replace(b, {person(bob, "bob")}, start);
  people.replace(b, {person(bob, "bob")}, start + limit);
  EXPECT_FALSE(people.forget_silent(start + limit).any) << "not yet";
  const auto change = people.forget_silent(start + limit + std::chrono::milliseconds(1));
  EXPECT_TRUE(change.any);
  EXPECT_THAT(change.left, ElementsAre(ada));
  EXPECT_THAT(users(), ElementsAre("bob"));
}

TEST_F(PeopleElsewhereTest, a_session_is_at_one_node_and_once_in_its_list) {
  people.replace(a, {person(ada, "ada"), person(ada, "again")}, start);
  people.replace(b, {person(ada, "false"), person(bob, "bob")}, start);
  EXPECT_THAT(users(), UnorderedElementsAre("ada", "bob"));
  std::vector<std::string> at_b;
  people.each_at(b, [&](const Presence& each) { at_b.push_back(each.user); });
  EXPECT_THAT(at_b, ElementsAre("bob"));
  people.replace(a, {}, start);
  EXPECT_THAT(users(), ElementsAre("bob"));
}

TEST_F(PeopleElsewhereTest, the_number_of_people_is_limited) {
  constexpr auto kMost = PeopleElsewhere::kMaxPeople;
  std::vector<Presence> many;
  for (std::size_t i = 0; i < kMost; ++i) many.push_back(person(random_uuid(), "many"));
  people.replace(b, {person(bob, "bob")}, start);
  people.replace(a, many, start);
  EXPECT_EQ(users().size(), kMost);
  EXPECT_TRUE(people.has(bob));
  EXPECT_FALSE(people.has(many.back().session));
  people.replace(a, {person(ada, "ada")}, start);
  EXPECT_THAT(users(), UnorderedElementsAre("ada", "bob"));
}

TEST_F(PeopleElsewhereTest, the_number_of_nodes_is_limited) {
  for (std::size_t i = 0; i < PeopleElsewhere::kMaxNodes; ++i)
    EXPECT_TRUE(people.replace(random_uuid(), {person(random_uuid(), "ada")}, start).any);
  EXPECT_FALSE(people.replace(b, {person(bob, "bob")}, start).any);
  EXPECT_FALSE(people.has(bob));
  EXPECT_EQ(users().size(), PeopleElsewhere::kMaxNodes);
}

}  // namespace
}  // namespace strata::room
