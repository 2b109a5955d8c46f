#include <gtest/gtest.h>

#include "core/role.h"

namespace strata {
namespace {

TEST(Role, names_read_back_and_ascend) {
  for (const char* text : {"guest", "viewer", "annotator", "curator", "administrator", "owner"})
    EXPECT_EQ(name(parse_role(text).value()), text);
  EXPECT_LT(parse_role("guest"), parse_role("viewer"));
  for (const char* text : {"", "Viewer", "king"}) EXPECT_FALSE(parse_role(text)) << text;
}

TEST(Roles, of_two_the_higher_one_counts) {
  const Roles roles{Role::annotator, {{1, Role::viewer}, {2, Role::curator}}};
  EXPECT_EQ(roles.in(1), Role::annotator);
  EXPECT_EQ(roles.in(2), Role::curator);
  EXPECT_EQ(roles.in(3), Role::annotator);
  EXPECT_EQ(roles.highest(), Role::curator);
  EXPECT_EQ(Roles{}.in(1), Role::guest);
}

TEST(Roles, a_cap_holds_in_every_project) {
  const Roles roles{Role::annotator, {{1, Role::viewer}, {2, Role::curator}}};
  EXPECT_EQ(roles.at_most(Role::viewer), (Roles{Role::viewer, {{1, Role::viewer}, {2, Role::viewer}}}));
  EXPECT_EQ(roles.at_most(Role::owner), roles);
}

}  // namespace
}  // namespace strata
