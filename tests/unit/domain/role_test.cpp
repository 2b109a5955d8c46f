#include <gtest/gtest.h>

#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/attachment.h"

namespace strata {
namespace {

TEST(Role, names_read_back_and_ascend) {
  for (const char* text : {"guest", "viewer", "annotator", "curator", "administrator", "owner"})
    EXPECT_EQ(name(parse_role(text).value()), text);
  EXPECT_LT(parse_role("guest"), parse_role("viewer"));
  for (const char* text : {"", "Viewer", "king"}) EXPECT_FALSE(parse_role(text)) << text;
}

TEST(Roles, of_two_the_higher_one_counts) {
  const Roles roles{Role::annotator, {{ProjectId(1), Role::viewer}, {ProjectId(2), Role::curator}}};
  EXPECT_EQ(roles.in(1), Role::annotator);
  EXPECT_EQ(roles.in(2), Role::curator);
  EXPECT_EQ(roles.in(3), Role::annotator);
  EXPECT_EQ(roles.highest(), Role::curator);
  EXPECT_EQ(Roles{}.in(1), Role::guest);
}

TEST(Roles, a_cap_holds_in_every_project) {
  const Roles roles{Role::annotator, {{ProjectId(1), Role::viewer}, {ProjectId(2), Role::curator}}};
  EXPECT_EQ(roles.at_most(Role::viewer),
            (Roles{Role::viewer, {{ProjectId(1), Role::viewer}, {ProjectId(2), Role::viewer}}}));
  EXPECT_EQ(roles.at_most(Role::owner), roles);
}

TEST(Visibility, each_is_seen_by_fewer_than_the_one_before) {
  const std::map<Visibility, Role> least{{Visibility::everyone, Role::viewer},
                                         {Visibility::team, Role::annotator},
                                         {Visibility::curators, Role::curator}};
  for (const Role role : {Role::guest, Role::viewer, Role::annotator, Role::curator,
                          Role::administrator, Role::owner})
    for (const auto& [visibility, from] : least) {
      EXPECT_EQ(sees(role, visibility), role >= from) << name(role) << " " << name(visibility);
      EXPECT_EQ(least_role(visibility), from);
      EXPECT_EQ(sight_of(from), visibility);
    }
  EXPECT_EQ(sight_of(Role::owner), Visibility::curators);
  for (const char* text : {"public", "team", "private"})
    EXPECT_EQ(name(parse_visibility(text).value()), text);
  for (const char* text : {"", "Public", "everyone"}) EXPECT_FALSE(parse_visibility(text)) << text;
}

TEST(Visibility, who_attached_a_file_sees_it_while_they_may_attach) {
  Attachment attachment;
  attachment.user = "ana";
  attachment.visibility = Visibility::curators;
  EXPECT_TRUE(sees(Author("ana", Role::annotator), attachment));
  EXPECT_FALSE(sees(Author("ana", Role::viewer), attachment));
  EXPECT_FALSE(sees(Author("ben", Role::annotator), attachment));
  EXPECT_TRUE(sees(Author("ben", Role::curator), attachment));
}

}  // namespace
}  // namespace strata
