#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "domain/scene/up.h"
#include "mesh/analysis/contact_shadow.h"
#include "support/solids.h"

namespace strata {
namespace {

using mesh::ContactShadow, test::ball, test::box, test::geometry_of;
constexpr int kSize = ContactShadow::kSize;

// The cover at a position of model space on the floor.
int cover(const ContactShadow& shadow, const glm::vec3& position) {
  const glm::vec3 from_corner = position - shadow.corner;
  const auto along = [&](const glm::vec3& side) {
    return std::clamp(static_cast<int>(glm::dot(from_corner, side) / glm::dot(side, side) * kSize),
                      0, kSize - 1);
  };
  return shadow.cover[static_cast<std::size_t>(along(shadow.along_column)) * kSize +
                      static_cast<std::size_t>(along(shadow.along_row))];
}

int darkest(const ContactShadow& shadow) { return *std::ranges::max_element(shadow.cover); }

TEST(ContactShadow, is_dark_under_a_box_soft_around_it_and_nothing_far_away) {
  const auto shadow = mesh::contact_shadow(geometry_of(box({-1, -1, 0}, {1, 1, 1})), "z");
  ASSERT_TRUE(shadow);
  const float floor = shadow->corner.z;
  EXPECT_FLOAT_EQ(floor, -0.5f) << "the lowest point: the origin is the center of the box";
  EXPECT_GT(cover(*shadow, {0, 0, floor}), 240);
  const int near = cover(*shadow, {1.03f, 0, floor}), farther = cover(*shadow, {1.2f, 0, floor});
  EXPECT_GT(near, 60);
  EXPECT_GT(near, farther);
  EXPECT_GT(farther, 0);
  for (int i = 0; i < kSize; ++i)
    for (const int texel : {i, i * kSize, (kSize - 1) * kSize + i, i * kSize + kSize - 1})
      ASSERT_EQ(shadow->cover[static_cast<std::size_t>(texel)], 0) << "the border of the map";
}

TEST(ContactShadow, of_a_raised_part_is_weaker) {
  // A table: the shadow of its plate is weaker than the shadow of its legs.
  mesh::TriangleMesh table = box({-1, -1, 0.5}, {1, 1, 0.6});
  for (const double x : {-0.9, 0.8})
    for (const double y : {-0.9, 0.8})
      test::add(table, box({x, y, 0}, {x + 0.1, y + 0.1, 0.5}), 1, false);
  const auto geometry = geometry_of(table);
  const auto shadow = mesh::contact_shadow(geometry, "z");
  ASSERT_TRUE(shadow);
  const float floor = shadow->corner.z;
  const glm::vec3 origin(geometry.origin);
  const int leg =
      cover(*shadow, glm::vec3(-0.85f, -0.85f, 0) - glm::vec3(origin.x, origin.y, -floor));
  const int middle = cover(*shadow, glm::vec3(0, 0, 0) - glm::vec3(origin.x, origin.y, -floor));
  EXPECT_GT(leg, middle);
  EXPECT_GT(middle, 0);
  EXPECT_LT(middle, 80);
}

TEST(ContactShadow, follows_the_up_direction) {
  // Six boxes with the same shape seen along their up direction.
  for (const std::string_view up : kUpDirections) {
    SCOPED_TRACE(up);
    const UpFrame frame = up_frame(up);
    const glm::dvec3 corner = -frame.right - 0.5 * frame.into,
                     other = frame.right + 0.5 * frame.into + frame.up;
    const auto shadow = mesh::contact_shadow(
        geometry_of(box(glm::min(corner, other), glm::max(corner, other))), up);
    ASSERT_TRUE(shadow);
    EXPECT_EQ(shadow->up, glm::vec3(frame.up));
    const glm::vec3 floor = -0.5f * glm::vec3(frame.up);  // the origin is the center of the box
    EXPECT_NEAR(glm::dot(shadow->corner - floor, shadow->up), 0, 1e-6);
    const glm::vec3 right(frame.right), into(frame.into);
    EXPECT_GT(cover(*shadow, floor + 0.9f * right), 200);
    EXPECT_LT(cover(*shadow, floor + 0.9f * into), 60);
    EXPECT_GT(cover(*shadow, floor + 0.4f * into), 200);
  }
}

TEST(ContactShadow, does_not_depend_much_on_the_number_of_triangles) {
  const auto coarse = mesh::contact_shadow(geometry_of(ball(16)), "z");
  const auto fine = mesh::contact_shadow(geometry_of(ball(128)), "z");
  ASSERT_TRUE(coarse && fine);
  EXPECT_GT(darkest(*fine), 100);
  for (std::size_t i = 0; i < fine->cover.size(); ++i)
    ASSERT_NEAR(coarse->cover[i], fine->cover[i], 20) << i;
}

TEST(ContactShadow, of_an_upright_sheet_is_a_line_and_of_a_point_is_nothing) {
  mesh::TriangleMesh sheet;
  sheet.positions = {{-1, 0, 0}, {1, 0, 0}, {-1, 0, 1}, {1, 0, 1}};
  sheet.triangles = {0, 1, 2, 1, 3, 2};
  const auto shadow = mesh::contact_shadow(geometry_of(sheet), "z");
  ASSERT_TRUE(shadow);
  EXPECT_GT(cover(*shadow, {0, 0, shadow->corner.z}), 20);
  EXPECT_LT(cover(*shadow, {0, 0.5f, shadow->corner.z}), 5);
  mesh::TriangleMesh column;  // no extent across `up`
  column.positions = {{0, 0, 0}, {0, 0, 1}, {0, 0, 2}};
  column.triangles = {0, 1, 2};
  EXPECT_FALSE(mesh::contact_shadow(geometry_of(column), "z"));
  EXPECT_FALSE(mesh::contact_shadow(mesh::Geometry{}, "z"));
}

}  // namespace
}  // namespace strata
