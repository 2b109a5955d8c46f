#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "store/content/idempotent_response.h"
#include "store/content/named_id.h"
#include "store/people/activity.h"

namespace strata::store {

class Pool;

// Projects of the site; `default` exists from the start. `ref` is an id in digits or a slug. Part
// of Store, whose rules for threads and errors apply.
class Projects {
 public:
  explicit Projects(Pool& pool) : pool_(pool) {}

  Result<std::vector<Project>> all();
  Result<Project> find(const std::string& ref);
  Result<Project> create(Project project, const IdempotentResponse<Project>& answer = {});
  // Changes the project if its version is the current one, and returns it with version + 1.
  Result<Project> update(Project project, const IdempotentResponse<Project>& answer = {});
  // Deletes the project. Returns a `conflict` error while it has models, and for `default`.
  Result<void> remove(ProjectId id, const IdempotentResponse<>& answer = {});
  // Returns the number of items that do not follow `place`. The items are sorted by name, ignoring
  // case, and then by id.
  Result<std::size_t> names_until(const NamedId& place, std::span<const NamedId> sorted);
  // Returns a text that changes whenever the models, layers, surface images, views, tables or
  // records of the project change. It does not depend on edits, comments or members. The text is
  // only meant for comparison.
  Result<std::string> state(ProjectId id);
  // Returns the project's activity without the lines about layers that the role does not see. The
  // cost of a page does not depend on the length of the history. An unknown project or model has no
  // activity.
  Result<ActivityPage> activity(ProjectId project_id, Role seen_by, const ActivityQuery& query);

 private:
  Pool& pool_;
};

}  // namespace strata::store
