#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <span>
#include <utility>

#include "core/ids.h"

namespace strata::room {

// Keys that can no longer be painted, because their records were deleted or are being deleted. The
// set is needed because a stroke may have begun before the deletion. Thread-safe.
class RetiredKeys {
 public:
  void retire(TableId table_id, std::span<const std::int64_t> keys) {
    std::lock_guard lock(mutex_);
    for (const auto key : keys) keys_.emplace(table_id, key);
  }
  void admit(TableId table_id, std::span<const std::int64_t> keys) {
    std::lock_guard lock(mutex_);
    for (const auto key : keys) keys_.erase({table_id, key});
  }
  bool has_any_of(TableId table_id) const {
    std::lock_guard lock(mutex_);
    const auto found = keys_.lower_bound({table_id, 0});
    return found != keys_.end() && found->first == table_id;
  }
  bool holds(TableId table_id, std::int64_t key) const {
    std::lock_guard lock(mutex_);
    return keys_.contains({table_id, key});
  }

 private:
  mutable std::mutex mutex_;
  std::set<std::pair<TableId, std::int64_t>> keys_;  // by table
};

}  // namespace strata::room
