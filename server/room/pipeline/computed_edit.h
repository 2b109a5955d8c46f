#pragma once

#include <cstdint>
#include <vector>

#include "domain/layers/layer.h"
#include "room/pipeline/region.h"
#include "store/journal/journal.h"
#include "store/store.h"

namespace strata::room {

// An edit that is computed from mirrors and not painted by the GPU: fill, polygon, import, patch,
// undo, redo, restore, review.
struct ComputedEdit {
  std::vector<TileChange> changes;
  // Edits that are no longer in force, and edits that are in force again.
  std::vector<std::int64_t> disable, enable;
  std::optional<store::JournalEntry::Reviewed> reviewed;
  std::vector<std::string> authors;  // names of the authors of the reviewed edits
};

// Blocks. For worker threads. `layer` is the layer to edit.
Result<ComputedEdit> compute_edit(const EditRequest& request, const Layer& layer,
                                  const RegionContext& context);

}  // namespace strata::room
