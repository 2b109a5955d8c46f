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

// People who are given roles in projects together; of the whole site.
struct Group {
  GroupId id = 0;
  std::string name;           // 1 to 100 characters; unique in any case
  std::int64_t people = 0;    // in it
  std::int64_t projects = 0;  // in which it has a role
};

// One group, and what hangs on it.
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
  std::int64_t losing = 0;          // people who could do less in some project without it
};

// A group's role in a project.
struct ProjectGroup {
  Group group;
  Role role = Role::viewer;
};

// What a group gives one person, above their own role there.
struct GivenRole {
  ProjectId project_id = 0;
  Role role = Role::viewer;
  std::string group;
};

// What is to be changed of a group; people by their names for signing in.
struct GroupChange {
  std::optional<std::string> name{};
  std::vector<std::string> add{}, remove{};
};

// What was changed, and whose roles with it: they must be asked for anew.
template <class Changed>
struct Regrouped {
  Changed now;
  std::vector<std::string> people;
};

// Groups of a Store, and as thread-safe and blocking as that, with the same Problems for what is
// not there or away. `by`: who asked, for the projects' activity; empty: it is not told there.
class Groups {
 public:
  static constexpr std::int64_t kMaxGroups = 200, kMaxPeople = 1000;  // of the site; in a group

  explicit Groups(Pool& pool) : pool_(pool) {}

  Result<std::vector<Group>> all();  // by name
  Result<GroupDetail> group(GroupId id);
  // Refused: a name that is empty or too long (invalid) or taken (conflict), nobody of a name
  // (invalid), too many groups or people (conflict).
  Result<GroupDetail> create(const std::string& name, const std::vector<std::string>& people);
  // The same. Who is in it already, or not in it, stays so.
  Result<Regrouped<GroupDetail>> change(GroupId id, const GroupChange& change,
                                        const std::string& by);
  // With the roles that it has.
  Result<std::vector<std::string>> remove(GroupId id, const std::string& by);

  // --- in projects
  Result<std::vector<ProjectGroup>> of_project(ProjectId project_id);  // by name
  // Gives the role (viewer, annotator or curator) in place of the one it had there.
  Result<Regrouped<ProjectGroup>> put(ProjectId project_id, GroupId id, Role role,
                                      const std::string& by);
  // not_found: it has none there.
  Result<std::vector<std::string>> take(ProjectId project_id, GroupId id, const std::string& by);

  // Who has a role there, of their own or by a group.
  Result<std::vector<PersonId>> people_with_role(ProjectId project_id);
  // by groups, by the name of these
  Result<std::vector<GivenRole>> roles_of(const std::string& user);

 private:
  Pool& pool_;
};

}  // namespace strata::store
