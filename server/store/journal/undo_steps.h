#pragma once

#include <optional>
#include <vector>

#include "store/journal/timeline.h"

namespace strata::store {

// A user's own step that undo or redo would change.
struct UndoStep : TimelineStep {
  std::optional<double> value;  // nothing: it painted no single value
  bool erases = false;
};
struct UndoSteps {
  std::vector<UndoStep> done;    // in force, newest first: the order of undos
  std::vector<UndoStep> undone;  // in the order of redos
  bool more = false;             // there are earlier steps in force
};
struct UndoQuery {
  std::vector<LayerId> layers;        // only edits of these
  std::vector<LayerId> pending_only;  // of these, only edits that wait for review
  int limit = 1;                      // of each of the two lists
};

}  // namespace strata::store
