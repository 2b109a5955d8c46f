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

// Users who get roles in projects together; of the whole site.
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
  std::vector<Member> members;  // by name
  struct InProject {
    std::string slug, name;
    Role role = Role::viewer;
  };
  std::vector<InProject> projects;  // by name
  std::int64_t losing = 0;          // users who could do less in some project without it
};

// A group's role in a project.
struct ProjectGroup {
  Group group;
  Role role = Role::viewer;
};

// A role that a group gives a user, above their own role in the project.
struct GivenRole {
  ProjectId project_id = 0;
  Role role = Role::viewer;
  std::string group;
};

// The change of a group; users by user name.
struct GroupChange {
  std::optional<std::string> name{};
  std::vector<std::string> add{}, remove{};
};

// The changed object and the users whose roles changed: their roles must be read again.
template <class Changed>
struct Regrouped {
  Changed now;
  std::vector<std::string> people;
};

// Groups of users. Part of Store: thread-safe and blocking as Store is, with the same errors for
// missing or unreachable data. `by`: the user named in the projects' activity; empty: no entry.
class Groups {
 public:
  static constexpr std::int64_t kMaxGroups = 200, kMaxPeople = 1000;  // of the site; in a group

  explicit Groups(Pool& pool) : pool_(pool) {}

  Result<std::vector<Group>> all();  // by name
  Result<GroupDetail> group(GroupId id);
  // Refused: a name that is empty or too long (invalid) or taken (conflict), an unknown user
  // (invalid), too many groups or users (conflict).
  Result<GroupDetail> create(const std::string& name, const std::vector<std::string>& people);
  // Refused as for `create`. Adding a member or removing a user who is not a member has no effect.
  Result<Regrouped<GroupDetail>> change(GroupId id, const GroupChange& change,
                                        const std::string& by);
  // Removes the group and its roles.
  Result<std::vector<std::string>> remove(GroupId id, const std::string& by);

  // --- in projects
  Result<std::vector<ProjectGroup>> of_project(ProjectId project_id);  // by name
  // Gives the role (viewer, annotator or curator), which replaces the former one there.
  Result<Regrouped<ProjectGroup>> put(ProjectId project_id, GroupId id, Role role,
                                      const std::string& by);
  // not_found: the group has no role in the project.
  Result<std::vector<std::string>> take(ProjectId project_id, GroupId id, const std::string& by);

  // Returns the users with a role in the project, of their own or by a group.
  Result<std::vector<PersonId>> people_with_role(ProjectId project_id);
  // by groups, in the order of the group names
  Result<std::vector<GivenRole>> roles_of(const std::string& user);

 private:
  Pool& pool_;
};

}  // namespace strata::store
