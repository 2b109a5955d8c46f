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

// Roles of users in single projects. Part of Store, whose rules for threads and errors apply.
class Members {
 public:
  explicit Members(Pool& pool) : pool_(pool) {}

  // Returns the users with a role in the project in addition to their role in the site, by name.
  Result<std::vector<Membership>> of_project(ProjectId project_id);
  // Gives the role (viewer, annotator or curator), which replaces the former role of the user in
  // the project. Returns a `not_found` error if the project or the user does not exist. `by` is the
  // user named in the activity of the project; if it is empty, the activity gets no entry.
  Result<Membership> put(ProjectId project_id, const std::string& user, Role role,
                         const std::string& by = {});
  // Removes the role that `put` gave. Returns a `not_found` error if there is no such role.
  Result<void> remove(ProjectId project_id, const std::string& user, const std::string& by = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
