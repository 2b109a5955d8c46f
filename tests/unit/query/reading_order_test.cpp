// The order of places for numbers that people read.
#include "query/regions/reading_order.h"

#include <gtest/gtest.h>

#include <vector>

namespace strata::query {
namespace {

using Order = std::vector<std::uint32_t>;

TEST(ReadingOrder, is_from_top_to_bottom_and_from_left_to_right) {
  // On a wall, up to a tenth of its height apart in each row.
  const std::vector<glm::dvec3> wall{{50, 3, 11}, {10, 0, 96}, {90, 2, 100}, {40, 1, 98},
                                     {20, 0, 12}, {5, 1, 50},  {7, 0, 0}};
  EXPECT_EQ(reading_order(wall, up_frame("z")), (Order{1, 3, 2, 5, 4, 0, 6}));
}

TEST(ReadingOrder, follows_the_up_direction_of_the_model) {
  std::vector<glm::dvec3> wall;
  const UpFrame frame = up_frame("-y");
  for (const auto& [right, up] : {std::pair(3.0, 0.0), std::pair(1.0, 0.0), std::pair(5.0, 9.0)})
    wall.push_back(right * frame.right + up * frame.up);
  EXPECT_EQ(reading_order(wall, frame), (Order{2, 1, 0}));
}

TEST(ReadingOrder, of_places_on_the_floor_is_that_of_the_view_from_above) {
  const std::vector<glm::dvec3> floor{{50, 10, 3}, {10, 96, 0}, {90, 100, 2}, {20, 12, 0}};
  EXPECT_EQ(reading_order(floor, up_frame("z")), (Order{1, 2, 3, 0}));
}

TEST(ReadingOrder, of_equal_places_or_none_is_theirs) {
  EXPECT_EQ(reading_order(std::vector<glm::dvec3>(3, {1, 2, 3}), up_frame("z")), (Order{0, 1, 2}));
  EXPECT_EQ(reading_order({}, up_frame("z")), Order{});
}

}  // namespace
}  // namespace strata::query
