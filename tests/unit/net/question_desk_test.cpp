// Waiting queries: a user has few running queries, users take turns, and the number of queries is
// limited.
#include "net/http/question_desk.h"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "protocol/problem.h"

namespace strata::net {
namespace {

Request from(const std::string& user, Role role = Role::viewer) {
  Request request;
  request.principal = Principal{user, role};
  return request;
}

class Desk : public testing::Test {
 protected:
  // Waits until no query is waiting or running. Only then may the objects that queries captured be
  // destroyed.
  void all_answered() {
    while (desk_.waiting() + desk_.under_way() > 0) std::this_thread::yield();
  }

  QuestionDesk desk_{{.threads = 1, .of_one_at_once = 1, .of_one_waiting = 3, .waiting = 5}};
};

TEST_F(Desk, the_next_is_of_who_has_the_fewest_under_way_and_waited_longest) {
  std::promise<void> begun, released;
  auto hold = released.get_future().share();
  std::string order;
  const auto post = [&](const std::string& user, std::function<void()> work) {
    ASSERT_TRUE(desk_.post(desk_.begin(from(user)), [&order, user, work] {
      order += user + " ";
      if (work) work();
    }));
  };
  post("ann", [&] {
    begun.set_value();
    hold.wait();
  });
  begun.get_future().wait();
  post("ann", {});
  post("ann", {});
  post("bob", {});
  post("cem", {});
  released.set_value();
  all_answered();
  EXPECT_EQ(order, "ann bob cem ann ann ");
}

TEST_F(Desk, refuses_one_s_too_many_with_429_and_all_s_too_many_with_503) {
  std::promise<void> begun, released;
  auto hold = released.get_future().share();
  ASSERT_TRUE(desk_.post(desk_.begin(from("ann")), [&] {
    begun.set_value();
    hold.wait();
  }));
  begun.get_future().wait();
  const auto ask = [&](const std::string& user) {
    const auto posted = desk_.post(desk_.begin(from(user)), [] {});
    return posted ? 200 : protocol::http_status(posted.error().code);
  };
  for (int i = 0; i < 3; ++i) EXPECT_EQ(ask("ann"), 200);
  EXPECT_EQ(ask("ann"), 429);
  EXPECT_EQ(ask("bob"), 200);
  EXPECT_EQ(ask("bob"), 200);
  EXPECT_EQ(ask("cem"), 503);
  released.set_value();
  all_answered();
}

TEST_F(Desk, a_question_is_the_current_one_where_it_is_answered_and_ends_with_the_server) {
  std::promise<int> answered;
  const auto question = desk_.begin(from("ann"));
  ASSERT_TRUE(desk_.post(question, [&] {
    EXPECT_EQ(Question::current(), question.get());
    try {
      for (;;) check_question();
    } catch (const QuestionEnded& ended) {
      answered.set_value(protocol::http_status(ended.problem().code));
    }
  }));
  desk_.end_all({ErrorCode::unavailable, "Server stops", "", {}});
  EXPECT_EQ(answered.get_future().get(), 503);
  EXPECT_TRUE(desk_.begin(from("bob"))->ended()) << "later ones are over before they begin";
}

}  // namespace
}  // namespace strata::net
