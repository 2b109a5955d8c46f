#pragma once

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/table.h"
#include "store/store.h"

// A layer or column is computed from and colored by other content. People who see it must also see
// that content; otherwise it would reveal restricted content. All functions block.
namespace strata::app {

// Checks the layer with its future settings against the other layers of its model. Refuses a
// palette that colors by a column that fewer people see (422, `palette.column`), and a layer from
// which layers visible to more people are computed (409, `visibility`).
Result<void> check_shows_nothing(store::Store& store, const Layer& layer,
                                 const std::vector<Layer>& others);

// Checks the column with its future visibility. Refuses (409, `visibility`) if a layer that more
// people see is colored by it or computed from it.
Result<void> check_shows_nothing(store::Store& store, const Table& table, const Column& column,
                                 Visibility visibility);

// Whether the role can see everything on the model that the formula names.
Result<bool> sees_all_of(store::Store& store, Role role, ModelId model_id,
                         const std::string& expression);

}  // namespace strata::app
