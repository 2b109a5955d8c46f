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

// Roles of people in single projects. Part of Store: its rules for threads and errors hold.
class Members {
 public:
  explicit Members(Pool& pool) : pool_(pool) {}

  // Who has a role in the project beside the one they have everywhere, by name.
  Result<std::vector<Membership>> of_project(ProjectId project_id);
  // Gives the role (viewer, annotator or curator) in place of the one they had there. not_found:
  // the project or the person is not there. `by`: who asked, for the project's activity; empty: it
  // is not told there.
  Result<Membership> put(ProjectId project_id, const std::string& user, Role role,
                         const std::string& by = {});
  // not_found: the person has no role of their own there.
  Result<void> remove(ProjectId project_id, const std::string& user, const std::string& by = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
