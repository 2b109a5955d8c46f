#pragma once

#include "core/ids.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/open/open_room.h"

namespace strata::room {

class OpenRoom::EditsPart final : public Edits {
 public:
  explicit EditsPart(OpenRoom& room) : room_(room) {}
  void submit(EditRequest request, Applied applied, Saved saved) override;
  std::int64_t sequence() const override { return room_.sequence_; }
  std::int64_t durable_sequence() const override { return room_.durable_; }
  DurableState durable_state() const override;
  Result<void> keep_sums(LayerId layer_id) override;

 private:
  Result<void> check_not_retired(const EditRequest& request) const;

  OpenRoom& room_;
};

}  // namespace strata::room
