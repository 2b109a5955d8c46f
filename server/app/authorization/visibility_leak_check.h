#pragma once

#include <string>

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/table.h"
#include "store/store.h"

// A layer may be computed from other content, and layers and columns may be colored by other
// content. Users who can see the result must also be allowed to see that content. Otherwise the
// result would reveal restricted content. All functions block.
namespace strata::app {

// Checks the layer with its future settings against the other layers of its model. Refuses a
// palette that uses a column visible to fewer users (422, `palette.column`). Refuses a layer that
// is the input of a layer visible to more users (409, `visibility`).
Result<void> check_shows_nothing(store::Store& store, const Layer& layer,
                                 const std::vector<Layer>& others);

// Checks the column with its future visibility. Refuses the visibility (409, `visibility`) if a
// layer that is visible to more users is colored by the column or computed from it.
Result<void> check_shows_nothing(store::Store& store, const Table& table, const Column& column,
                                 Visibility visibility);

// Checks that all users who see the painted layer may also see the layer from which it is painted.
// Otherwise refuses the layer (422 at `field`).
Result<void> check_all_may_see(const Layer& source, const Layer& painted, const std::string& field);

// Returns whether the role can see all content of the model that the formula names.
Result<bool> sees_all_of(store::Store& store, Role role, ModelId model_id,
                         const std::string& expression);

}  // namespace strata::app
