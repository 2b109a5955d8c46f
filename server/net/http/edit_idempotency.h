#pragma once

#include <map>
#include <mutex>

#include "core/ids.h"
#include "net/http/http_types.h"
#include "room/edit.h"
#include "store/store.h"

namespace strata::net {

// Binds an Idempotency-Key to one edit. The id of an edit is derived from its key, so the journal
// detects a repeated edit. This class refuses (422) a key that another edit has used. That edit may
// already be in the journal or may still be running. Thread-safe, blocks.
class EditIdempotency {
 public:
  explicit EditIdempotency(store::Store& store) : store_(store) {}

  // Registers the edit. After a success, call `end` when the edit is done.
  Result<void> begin(ModelId model_id, const room::EditRequest& edit);
  void end(const Uuid& id);

 private:
  struct AtWork {
    nlohmann::json record;
    int calls = 0;
  };
  store::Store& store_;
  std::mutex mutex_;
  std::map<Uuid, AtWork> at_work_;
};

}  // namespace strata::net
