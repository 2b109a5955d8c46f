#pragma once

#include <cstdint>
#include <vector>

#include "domain/layers/layer.h"
#include "room/pipeline/region.h"
#include "store/journal/journal.h"
#include "store/store.h"

namespace strata::room {

// An edit that is computed from mirrors, and not painted by the GPU: fill, polygon, import, undo,
// redo, restore, review.
struct ComputedEdit {
  std::vector<TileChange> changes;
  std::vector<std::int64_t> disable, enable;  // edits that are no longer in force, or in force
                                              // again
  std::optional<store::JournalEntry::Reviewed> reviewed;
  std::vector<std::string> authors;  // of the reviewed edits, by name
};

// Blocks: for worker threads. `layer` is the edited one.
Result<ComputedEdit> compute_edit(const EditRequest& request, const Layer& layer,
                                  const RegionContext& context);

}  // namespace strata::room
