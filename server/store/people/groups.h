#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"

namespace strata::store {

class Pool;

// Users of the site who get roles in projects together.
struct Group {
  GroupId id = 0;
  std::string name;           // 1 to 100 characters; unique, ignoring case
  std::int64_t people = 0;    // number of members
  std::int64_t projects = 0;  // number of projects in which it has a role
};

// One group, with its members and projects.
struct GroupDetail {
  Group group;
  struct Member {
    std::string user, full_name;
  };
  std::vector<Member> members;  // sorted by name
  struct InProject {
    std::string slug, name;
    Role role = Role::viewer;
  };
  std::vector<InProject> projects;  // sorted by name
  std::int64_t losing = 0;  // number of users who would lose rights in a project without the group
};

// A group's role in a project.
struct ProjectGroup {
  Group group;
  Role role = Role::viewer;
};

// A role that a group gives to a user, above the user's own role in the project.
struct GivenRole {
  ProjectId project_id = 0;
  Role role = Role::viewer;
  std::string group;
};

// A change to a group. `add` and `remove` are user names.
struct GroupChange {
  std::optional<std::string> name{};
  std::vector<std::string> add{}, remove{};
};

// The changed object, and the users whose roles changed. The caller must read their roles again.
template <class Changed>
struct Regrouped {
  Changed now;
  std::vector<std::string> people;
};

// Groups of users. Part of Store, whose rules for threads and errors apply. `by` is the user named
// in the activity of the projects; if it is empty, the activity gets no entry.
class Groups {
 public:
  // limits for groups of the site, and for users in a group
  static constexpr std::int64_t kMaxGroups = 200, kMaxPeople = 1000;

  explicit Groups(Pool& pool) : pool_(pool) {}

  Result<std::vector<Group>> all();  // sorted by name
  Result<GroupDetail> group(GroupId id);
  // Returns an `invalid` error for a name that is empty or too long, and for an unknown user.
  // Returns a `conflict` error for a name that is taken, and for too many groups or users.
  Result<GroupDetail> create(const std::string& name, const std::vector<std::string>& people);
  // Returns the same errors as `create`. It is no error to add a user who is already a member, or
  // to remove a user who is not a member.
  Result<Regrouped<GroupDetail>> change(GroupId id, const GroupChange& change,
                                        const std::string& by);
  // Removes the group and its roles.
  Result<std::vector<std::string>> remove(GroupId id, const std::string& by);

  // --- in projects
  Result<std::vector<ProjectGroup>> of_project(ProjectId project_id);  // sorted by name
  // Gives the role (viewer, annotator or curator), which replaces the former role of the group in
  // the project.
  Result<Regrouped<ProjectGroup>> put(ProjectId project_id, GroupId id, Role role,
                                      const std::string& by);
  // Removes the role. Returns a `not_found` error if the group has no role in the project.
  Result<std::vector<std::string>> take(ProjectId project_id, GroupId id, const std::string& by);

  // Returns the users with a role in the project, either their own role or one from a group.
  Result<std::vector<PersonId>> people_with_role(ProjectId project_id);
  // Returns the roles that groups give to the user, in the order of the group names.
  Result<std::vector<GivenRole>> roles_of(const std::string& user);

 private:
  Pool& pool_;
};

}  // namespace strata::store
