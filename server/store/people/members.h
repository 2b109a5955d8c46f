#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "store/people/people.h"

namespace strata::store {

class Pool;

// Roles of users in single projects. Part of Store: its rules for threads and errors hold.
class Members {
 public:
  explicit Members(Pool& pool) : pool_(pool) {}

  // Returns users with a role in the project in addition to their role in the site, by name.
  Result<std::vector<Membership>> of_project(ProjectId project_id);
  // Gives the role (viewer, annotator or curator), which replaces the former one there. not_found:
  // the project or the user does not exist. `by`: the user named in the project's activity; empty:
  // no entry.
  Result<Membership> put(ProjectId project_id, const std::string& user, Role role,
                         const std::string& by = {});
  // not_found: the user has no role of their own there.
  Result<void> remove(ProjectId project_id, const std::string& user, const std::string& by = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
