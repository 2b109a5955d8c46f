#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/ids.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;

// The metadata of a project for a repository.
struct StoredMetadata {
  nlohmann::json record;     // DepositRecord of the protocol; null if nothing was saved yet
  std::int64_t version = 0;  // 0 if nothing was saved yet
};

// Metadata of projects. Part of Store, whose rules for threads and errors apply.
class Metadata {
 public:
  explicit Metadata(Pool& pool) : pool_(pool) {}

  Result<StoredMetadata> of_project(ProjectId project_id);
  // Replaces the record if `version` is the current version. The caller has checked the record.
  Result<StoredMetadata> replace(ProjectId project_id, const nlohmann::json& record,
                                 std::int64_t version,
                                 const IdempotentResponse<StoredMetadata>& answer = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
