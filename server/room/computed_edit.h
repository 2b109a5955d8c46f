#pragma once

#include <cstdint>
#include <vector>

#include "room/region.h"
#include "store/store.h"

namespace strata::room {

// An edit that is computed from mirrors rather than painted by the GPU: fill, polygon, import, undo, redo, restore.
struct ComputedEdit {
  std::vector<TileChange> changes;
  std::vector<std::int64_t> disable, enable;  // edits that are no longer in force, or are again
};

// Blocks: for worker threads. `layer` is the edited one.
Result<ComputedEdit> compute_edit(const EditRequest& request, const Layer& layer, const RegionContext& context);

}  // namespace strata::room
