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
#include "store/people/activity.h"

namespace strata::store {

class Pool;

// How many of the things, which are sorted by their names without regard to case and then by ids,
// do not come after that place.
struct NamedId {
  std::string name;
  std::int64_t id = 0;
};

// Projects of the site; `default` exists from the start. `ref` is an id in digits or a slug. Part
// of Store: its rules for threads and errors hold.
class Projects {
 public:
  explicit Projects(Pool& pool) : pool_(pool) {}

  Result<std::vector<Project>> all();
  Result<Project> find(const std::string& ref);
  Result<Project> create(Project project, const IdempotentResponse<Project>& answer = {});
  // Where version equals; returns it with version + 1.
  Result<Project> update(Project project, const IdempotentResponse<Project>& answer = {});
  // refused (conflict) while it has models, and for `default`
  Result<void> remove(ProjectId id, const IdempotentResponse<>& answer = {});
  Result<std::size_t> names_until(const NamedId& place, std::span<const NamedId> sorted);
  // Of all that is stored of it but edits, comments and people: another text whenever one of its
  // models, layers, looks, views or tables was changed, made or deleted, or a record of its tables.
  // For comparison alone.
  Result<std::string> state(ProjectId id);
  // What was done in it, but for what is about layers that the role does not see; a page costs the
  // same however long its history is. An unknown project or model has none.
  Result<ActivityPage> activity(ProjectId project_id, Role seen_by, const ActivityQuery& query);

 private:
  Pool& pool_;
};

}  // namespace strata::store
