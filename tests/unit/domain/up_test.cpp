#include "domain/scene/up.h"

#include <gtest/gtest.h>

#include "domain/scene/compass.h"

namespace strata {
namespace {

TEST(Up, every_direction_has_a_right_handed_frame_with_it_on_top) {
  for (const std::string_view name : kUpDirections) {
    const UpFrame frame = up_frame(name);
    EXPECT_EQ(glm::cross(frame.right, frame.into), frame.up) << name;
    const int axis = name.back() - 'x';
    glm::dvec3 expected(0);
    expected[axis] = name.starts_with('-') ? -1 : 1;
    EXPECT_EQ(frame.up, expected) << name;
    EXPECT_TRUE(is_up(name));
  }
  for (const std::string_view other : {"", "w", "+x", "--x", "zz", "- z", "Z"})
    EXPECT_FALSE(is_up(other)) << other;
}

TEST(Up, north_and_east_lie_level_and_turn_clockwise_as_seen_from_above) {
  for (const std::string_view name : kUpDirections) {
    Model model;
    model.up = name;
    model.north = "90";
    const Compass compass(model);
    const glm::dvec3 up = up_frame(name).up;
    EXPECT_EQ(glm::cross(compass.east, compass.north), up) << name;
    EXPECT_LT(glm::length(compass.true_north() - compass.east), 1e-12) << name;
  }
  Model head_down;
  head_down.up = "-z";
  EXPECT_EQ(Compass(head_down).north, glm::dvec3(0, -1, 0));
}

}  // namespace
}  // namespace strata
