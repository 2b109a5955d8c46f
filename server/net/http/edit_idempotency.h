#pragma once

#include <map>
#include <mutex>

#include "core/ids.h"
#include "net/http/http_types.h"
#include "room/edit.h"
#include "store/store.h"

namespace strata::net {

// Keeps an Idempotency-Key to one edit. The journal gives a repeat its first answer, by the id that
// follows from the key; here another edit with the key of one that is in the journal, or on its way
// there, is refused (422). Thread-safe, blocks.
class EditIdempotency {
 public:
  explicit EditIdempotency(store::Store& store) : store_(store) {}

  // Then `end` must follow.
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
