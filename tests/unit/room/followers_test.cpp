#include "room/open/followers.h"

#include <gtest/gtest.h>

namespace strata::room {
namespace {

struct FollowersTest : testing::Test {
  Followers followers;
  const Uuid anna = random_uuid(), bea = random_uuid(), carl = random_uuid();
};

TEST_F(FollowersTest, one_follows_one_at_a_time) {
  EXPECT_TRUE(followers.follow(anna, bea).value());
  EXPECT_FALSE(followers.follow(anna, bea).value()) << "nothing new";
  EXPECT_TRUE(followers.follow(anna, carl).value());
  EXPECT_EQ(followers.leader_of(anna), carl);
  EXPECT_FALSE(followers.has_followers(bea));
  EXPECT_TRUE(followers.has_followers(carl));
  EXPECT_TRUE(followers.stop(anna));
  EXPECT_FALSE(followers.stop(anna));
  EXPECT_FALSE(followers.leader_of(anna));
}

TEST_F(FollowersTest, nobody_follows_themselves_however_long_the_way_round) {
  for (const Uuid& way : {anna, bea, carl})
    EXPECT_EQ(followers.follow(way, way).error().code, ErrorCode::conflict);
  ASSERT_TRUE(followers.follow(anna, bea));
  EXPECT_EQ(followers.follow(bea, anna).error().field, "follow");
  ASSERT_TRUE(followers.follow(bea, carl));
  EXPECT_EQ(followers.follow(carl, anna).error().code, ErrorCode::conflict);
  EXPECT_FALSE(followers.leader_of(carl)) << "what is refused changes nothing";
  ASSERT_TRUE(followers.stop(bea));
  EXPECT_TRUE(followers.follow(carl, anna)) << "the way is open";
}

TEST_F(FollowersTest, who_leaves_is_followed_by_nobody) {
  ASSERT_TRUE(followers.follow(anna, bea));
  ASSERT_TRUE(followers.follow(bea, carl));
  followers.leave(bea);
  EXPECT_FALSE(followers.leader_of(anna));
  EXPECT_FALSE(followers.leader_of(bea));
  EXPECT_FALSE(followers.has_followers(carl));
}

}  // namespace
}  // namespace strata::room
