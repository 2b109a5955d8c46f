#include <gtest/gtest.h>

#include "store/pg.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using std::chrono::seconds;

TEST(Tokens, a_token_is_found_until_it_is_revoked_or_expires) {
  auto store = test::fresh_store();
  const auto token = store->create_token(Store::TokenKind::script, "Ada", "owner", {}).value();
  EXPECT_EQ(token.size(), 43u);
  EXPECT_EQ(token.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"),
            std::string::npos);
  const auto found = store->find_token(token).value();
  ASSERT_TRUE(found);
  EXPECT_EQ(found->user, "Ada");
  EXPECT_EQ(found->role, "owner");
  EXPECT_EQ(found->kind, Store::TokenKind::script);
  ASSERT_TRUE(store->revoke_token(token));
  EXPECT_FALSE(store->find_token(token).value());
  const auto old = store->create_token(Store::TokenKind::session, "Ada", "owner", seconds(-1)).value();
  EXPECT_FALSE(store->find_token(old).value());
  const auto fresh = store->create_token(Store::TokenKind::session, "Ada", "owner", seconds(3600)).value();
  EXPECT_TRUE(store->find_token(fresh).value());
  EXPECT_NE(fresh, store->create_token(Store::TokenKind::session, "Ada", "owner", seconds(3600)).value());
}

TEST(Tokens, guesses_and_oddities_are_nobody) {
  auto store = test::fresh_store();
  for (const std::string guess : {"", "x", "' OR 1=1 --", "\xff\xff"})
    EXPECT_FALSE(store->find_token(guess).value()) << guess;
  EXPECT_EQ(store->create_token(Store::TokenKind::script, "", "owner", {}).error().status, 400);
  EXPECT_EQ(store->create_token(Store::TokenKind::script, "\xff", "owner", {}).error().status, 400);
}

TEST(Tokens, secrets_are_not_in_the_database) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  const auto token = store->create_token(Store::TokenKind::script, "Ada", "owner", {}).value();
  auto rows = PgConnection::connect(dsn)->query(
      "SELECT octet_length(hash)::bigint, position(convert_to($1, 'UTF8') in hash) "
      "FROM tokens",
      Params().text(token));
  ASSERT_TRUE(rows);
  EXPECT_EQ(rows->integer(0, 0), 32);
  EXPECT_EQ(rows->integer(0, 1), 0);
}

TEST(Tokens, an_owner_link_opens_sessions_until_it_is_revoked) {
  auto store = test::fresh_store();
  const auto link = store->create_token(Store::TokenKind::owner_link, "owner", "owner", {}).value();
  const auto first = store->redeem_owner_link(link, seconds(60)).value();
  const auto second = store->redeem_owner_link(link, seconds(60)).value();
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_EQ(store->find_token(*first).value()->kind, Store::TokenKind::session);
  EXPECT_EQ(store->find_token(*first).value()->role, "owner");
  EXPECT_FALSE(store->redeem_owner_link(*first, seconds(60)).value());  // a session is no link
  EXPECT_FALSE(store->redeem_owner_link("guess", seconds(60)).value());
  ASSERT_TRUE(store->revoke_token(link));
  EXPECT_FALSE(store->redeem_owner_link(link, seconds(60)).value());
  EXPECT_TRUE(store->find_token(*first).value());
}

FirstAnswer<Project> answer_of(const std::string& key) {
  return {key, [](const Project& made) { return nlohmann::json{{"status", 201}, {"id", made.id}, {"area", 0.1}}; }};
}

Project named(const std::string& name) {
  Project project;
  project.name = name;
  return project;
}

TEST(Answers, an_answer_is_kept_with_the_change_for_seven_days) {
  const auto dsn = test::fresh_database();
  auto store = test::open_store(dsn);
  EXPECT_FALSE(store->find_answer("k").value());
  const auto made = store->create_project(named("Villa"), answer_of("k")).value();
  const nlohmann::json first = {{"status", 201}, {"id", made.id}, {"area", 0.1}};
  EXPECT_EQ(store->find_answer("k").value(), first);
  auto connection = PgConnection::connect(dsn);
  ASSERT_TRUE(connection->script("UPDATE answers SET time = time - interval '6 days 23 hours'"));
  EXPECT_EQ(store->find_answer("k").value(), first);
  ASSERT_TRUE(connection->script("UPDATE answers SET time = time - interval '2 hours'"));
  EXPECT_FALSE(store->find_answer("k").value());
  const auto again = store->create_project(named("Villa"), answer_of("k")).value();
  EXPECT_EQ(store->find_answer("k").value()->at("id"), again.id);
}

TEST(Answers, of_two_calls_with_one_key_only_one_changes_anything) {
  auto store = test::fresh_store();
  ASSERT_TRUE(store->create_project(named("Villa"), answer_of("k")));
  const auto second = store->create_project(named("Villa"), answer_of("k"));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().status, 409);
  EXPECT_EQ(store->projects()->size(), 2u) << "`default` and the first";
}

TEST(Answers, what_changes_nothing_keeps_no_answer) {
  auto store = test::fresh_store();
  EXPECT_FALSE(store->create_project(named(""), answer_of("k")));
  EXPECT_FALSE(store->delete_project(1, {"gone", [] { return nlohmann::json{{"status", 204}}; }}));
  EXPECT_FALSE(store->find_answer("k").value());
  EXPECT_FALSE(store->find_answer("gone").value());
}

TEST(Answers, bad_keys_are_the_callers_mistake) {
  auto store = test::fresh_store();
  EXPECT_EQ(store->find_answer("").error().status, 400);
  for (const std::string& key : {std::string(256, 'k'), std::string("a\0b", 3), std::string("\xff")}) {
    EXPECT_EQ(store->find_answer(key).error().status, 400);
    EXPECT_EQ(store->create_project(named("x"), answer_of(key)).error().status, 400);
  }
  EXPECT_EQ(store->projects()->size(), 1u);
}

}  // namespace
}  // namespace strata::store
