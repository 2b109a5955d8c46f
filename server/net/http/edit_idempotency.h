#pragma once

#include <map>
#include <mutex>

#include "core/ids.h"
#include "net/http/http_types.h"
#include "room/edit.h"
#include "store/store.h"

namespace strata::net {

// Binds an Idempotency-Key to one edit. The journal answers a repeat by the id that is derived from
// the key; this class refuses (422) another edit with the key of an edit that is in the journal or
// on its way there. Thread-safe, blocks.
class EditIdempotency {
 public:
  explicit EditIdempotency(store::Store& store) : store_(store) {}

  // Call `end` afterwards.
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
