#pragma once

#include <optional>
#include <vector>

#include "store/journal/timeline.h"

namespace strata::store {

// A step of the user that undo or redo would change.
struct UndoStep : TimelineStep {
  std::optional<double> value;  // nothing if the step did not paint a single value
  bool erases = false;
};
struct UndoSteps {
  std::vector<UndoStep> done;    // steps in force, newest first: the order of undo
  std::vector<UndoStep> undone;  // undone steps, in the order of redo
  bool more = false;             // true if there are earlier steps in force
};
struct UndoQuery {
  std::vector<LayerId> layers;        // only edits of these layers
  std::vector<LayerId> pending_only;  // layers where only edits that wait for review are steps
  int limit = 1;                      // limit for each of the two lists
};

}  // namespace strata::store
