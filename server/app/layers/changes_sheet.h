#pragma once

#include <string>

#include "app/layers/layer_changes.h"
#include "app/records/sheet.h"
#include "domain/people/role.h"

namespace strata::app {

// Returns the areas of the changes as a table for a spreadsheet, with the names of the classes as
// visible to `seen_by`, sums, and the areas without a counterpart in the last row and column. `now`
// is the layer of the open model.
Result<Sheet> changes_sheet(store::Store& store, const LayerChanges& changes, const Layer& now,
                            const ChangesSince& since, Role seen_by, const std::string& language);

}  // namespace strata::app
