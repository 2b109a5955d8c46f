#include "jobs/demo_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace strata::jobs {
namespace {

// Returns evenly spaced points on a ball.
std::vector<glm::vec3> ball(int count, float radius) {
  std::vector<glm::vec3> points;
  for (int i = 0; i < count; ++i) {
    const float z = 1 - 2 * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    const float angle = 2.39996323f * static_cast<float>(i), r = std::sqrt(1 - z * z);
    points.push_back(radius * glm::vec3(r * std::cos(angle), r * std::sin(angle), z));
  }
  return points;
}

TEST(JobsDemoRules, every_point_belongs_to_a_sherd_and_all_sherds_are_there) {
  const auto points = ball(60'000, 50);
  const DemoRules rules(points);
  std::array<int, DemoRules::kSherds + 1> count{};
  for (const auto& p : points) {
    const int sherd = rules.at(p).sherd;
    ASSERT_GE(sherd, 1);
    ASSERT_LE(sherd, DemoRules::kSherds);
    ++count[sherd];
  }
  for (int i = 1; i <= DemoRules::kSherds; ++i)
    EXPECT_GT(count[i], 60'000 / DemoRules::kSherds / 6) << "sherd " << i;
}

TEST(JobsDemoRules, cracks_of_all_three_classes_are_thin_and_few) {
  const auto points = ball(60'000, 50);
  const DemoRules rules(points);
  std::array<int, 4> count{};
  for (const auto& p : points) ++count[rules.at(p).crack];
  const double all = 60'000;
  EXPECT_GT(count[DemoRules::hairline] / all, 0.002);
  EXPECT_GT(count[DemoRules::crack] / all, 0.01);
  EXPECT_GT(count[DemoRules::open_crack] / all, 0.01);
  EXPECT_LT((all - count[DemoRules::none]) / all, 0.25);
}

TEST(JobsDemoRules, a_sherd_goes_through_the_wall) {
  const auto outside = ball(20'000, 50);
  const DemoRules rules(outside);
  for (const auto& p : outside) {
    const auto inside = rules.at(p * 0.9f), here = rules.at(p);
    ASSERT_EQ(inside.sherd == here.sherd || here.crack != DemoRules::none ||
                  inside.crack != DemoRules::none,
              true);
  }
}

TEST(JobsDemoRules, the_order_of_the_points_does_not_matter) {
  const auto points = ball(20'000, 50);
  auto shuffled = points;
  std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(3));
  const DemoRules one(points), two(shuffled);
  for (const auto& p : points) {
    ASSERT_EQ(one.at(p).sherd, two.at(p).sherd);
    ASSERT_EQ(one.at(p).crack, two.at(p).crack);
  }
}

TEST(JobsDemoRules, the_rule_gives_the_same_every_time) {
  const auto points = ball(5'000, 50);
  const DemoRules one(points), two(points);
  for (const auto& p : points) {
    ASSERT_EQ(one.at(p).sherd, two.at(p).sherd);
    ASSERT_EQ(one.at(p).crack, two.at(p).crack);
  }
}

}  // namespace
}  // namespace strata::jobs
