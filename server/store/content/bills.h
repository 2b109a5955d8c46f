#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "store/content/idempotent_response.h"

namespace strata::store {

class Pool;

using BillId = Id<struct BillTag>;

// A bill of quantities. The store does not interpret the content (protocol::BillWrite without the
// name).
struct StoredBill {
  BillId id = 0;
  ProjectId project_id = 0;
  std::string name;  // unique in the project, ignoring case
  nlohmann::json content;
  int positions = 0;
  std::int64_t version = 1;
};

// Bills of quantities of projects. Part of Store, whose rules for threads and errors apply.
class Bills {
 public:
  static constexpr std::int64_t kMaxBills = 1000;  // in a project

  explicit Bills(Pool& pool) : pool_(pool) {}

  // Returns the bills, sorted by their ids, without their content.
  Result<std::vector<StoredBill>> of_project(ProjectId project_id);
  Result<StoredBill> find(ProjectId project_id, BillId id);
  // Returns a `conflict` error for a name that is taken, and for too many bills.
  Result<StoredBill> create(const StoredBill& bill,
                            const IdempotentResponse<StoredBill>& answer = {});
  // Replaces the name and content if the version is the current one, and returns the bill with
  // version + 1.
  Result<StoredBill> replace(const StoredBill& bill,
                             const IdempotentResponse<StoredBill>& answer = {});
  Result<void> remove(const StoredBill& bill, const IdempotentResponse<>& answer = {});

 private:
  Pool& pool_;
};

}  // namespace strata::store
