#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/scene/surveyed_object.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;

// Objects of a project, whose models are surveys of them. Models::update puts a model into an
// object and takes it out. Models in the Trash are not surveys of their object. Part of Store,
// whose rules for threads and errors apply.
class Objects {
 public:
  static constexpr std::int64_t kMaxObjects = 10'000;  // in a project
  static constexpr std::int64_t kMaxSurveys = 200;     // of an object, with those in the Trash

  struct Page {
    std::vector<SurveyedObject> objects;
    std::int64_t total = 0;
  };

  explicit Objects(Pool& pool) : pool_(pool) {}

  // Returns the objects with ids above `after`, in the order of their ids.
  Result<Page> of_project(ProjectId project_id, int limit, int offset, std::int64_t after);
  Result<SurveyedObject> find(ProjectId project_id, ObjectId id);
  // Returns a `conflict` error for a name that is taken, and for too many objects.
  Result<SurveyedObject> create(ProjectId project_id, const std::string& name,
                                const IdempotentResponse<SurveyedObject>& answer = {});
  // Renames the object if its version is the current one, and returns it with version + 1.
  Result<SurveyedObject> rename(const SurveyedObject& object,
                                const IdempotentResponse<SurveyedObject>& answer = {});
  // Returns a `conflict` error while the object has surveys. Models in the Trash leave it.
  Result<void> remove(const SurveyedObject& object, const IdempotentResponse<>& answer = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
