#include "net/auth/login_throttle.h"

#include <gtest/gtest.h>

namespace strata::net {
namespace {

using std::chrono::seconds;

struct Gate {
  LoginThrottle gate;
  LoginThrottle::Clock::time_point now = LoginThrottle::Clock::now();
  bool pass(const std::string& address, const std::string& name) {
    return gate.pass(address, name, now).has_value();
  }
  int passed(int tries, const std::string& address, const std::string& name) {
    int count = 0;
    for (int i = 0; i < tries; ++i) {
      count += pass(address, name);
      now += seconds(1);
    }
    return count;
  }
};

TEST(LoginThrottle, guesses_for_a_name_are_few_from_an_address_and_bounded_from_many) {
  Gate at;
  const int alone = at.passed(600, "10.0.0.1", "ada");
  EXPECT_GE(alone, 60);
  EXPECT_LE(alone, 71);  // in ten minutes
  int count = 0;
  for (int i = 0; i < 600; ++i)
    count += at.passed(1, "10.0." + std::to_string(i) + ".1", i % 2 ? "Ada" : "ada");
  EXPECT_LE(count, 361);
  for (int i = 0; i < 600; ++i) at.pass("10.1." + std::to_string(i) + ".1", "ada");
  const auto refused = at.gate.pass("10.2.0.1", "ada", at.now);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code, ErrorCode::too_many_requests);
  EXPECT_TRUE(at.pass("10.2.0.1", "grace"));
}

TEST(LoginThrottle, who_was_right_from_an_address_is_not_held_up_by_guesses_from_others) {
  Gate at;
  ASSERT_TRUE(at.pass("10.0.0.1", "ada"));
  at.gate.was_right("10.0.0.1", "ADA");
  for (int i = 0; i < 600; ++i) at.pass("10.1." + std::to_string(i) + ".1", "ada");
  EXPECT_FALSE(at.pass("10.0.0.2", "ada"));
  EXPECT_TRUE(at.pass("10.0.0.1", "ada"));
}

TEST(LoginThrottle, an_address_that_is_too_fast_takes_nothing_from_others) {
  Gate at;
  for (int i = 0; i < 1000; ++i) at.pass("10.0.0.1", "name" + std::to_string(i));
  EXPECT_FALSE(at.pass("10.0.0.1", "ada"));
  EXPECT_FALSE(at.pass("10.0.0.1", ""));
  EXPECT_TRUE(at.pass("10.0.0.2", "ada"));
}

TEST(LoginThrottle, who_is_right_may_come_again_and_again_as_fast_as_an_address_may) {
  Gate at;
  for (int i = 0; i < 200; ++i) {
    ASSERT_TRUE(at.pass("10.0.0.1", "ada")) << i;
    at.gate.was_right("10.0.0.1", "ADA");
    at.now += seconds(1);
  }
}

TEST(LoginThrottle,
     so_many_addresses_that_none_can_be_kept_in_mind_give_no_more_guesses_for_a_name) {
  Gate at;
  int count = 0;
  for (int i = 0; i < 150'000; ++i) count += at.pass("address " + std::to_string(i), "ada");
  EXPECT_EQ(count, 60);
}

TEST(LoginThrottle, the_address_is_that_of_the_peer_unless_it_is_a_proxy_of_this_machine) {
  Request request;
  request.peer = "192.0.2.7";
  request.headers = {{"x-forwarded-for", "10.0.0.1"}};
  EXPECT_EQ(address_of(request), "192.0.2.7");
  request.peer = "127.0.0.1";
  EXPECT_EQ(address_of(request), "10.0.0.1");
  request.headers = {{"x-forwarded-for", "6.6.6.6, 10.0.0.2"}};
  EXPECT_EQ(address_of(request), "10.0.0.2");
  request.headers = {{"x-forwarded-for", "6.6.6.6"}, {"x-forwarded-for", "10.0.0.3"}};
  EXPECT_EQ(address_of(request), "10.0.0.3");
  request.headers = {{"x-forwarded-for", "unknown"}};
  EXPECT_EQ(address_of(request), "127.0.0.1");
  request.peer = "::ffff:127.0.0.1";
  request.headers = {{"x-forwarded-for", "2001:db8:1:2:3:4:5:6"}};
  EXPECT_EQ(address_of(request), "2001:db8:1:2::/64");
  request.peer = "127.0.0.1";
  request.headers.clear();
  EXPECT_EQ(address_of(request), "127.0.0.1");
}

}  // namespace
}  // namespace strata::net
