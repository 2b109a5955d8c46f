#pragma once

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/tables/table.h"
#include "store/store.h"

// Who sees a layer or a column must see all that it is made of and coloured by, or what few people
// see would show through. All of it blocks.
namespace strata::app {

// The layer as it is to be, among the layers of its model. Refused: its palette colours by a column
// that fewer see (422, `palette.column`), or layers that more people see are computed from it (409,
// `visibility`).
Result<void> check_shows_nothing(store::Store& store, const Layer& layer,
                                 const std::vector<Layer>& others);

// A column of the table that is to be seen so. Refused (409, `visibility`): a layer that more
// people see is coloured by it or computed from it.
Result<void> check_shows_nothing(store::Store& store, const Table& table, const Column& column,
                                 Visibility visibility);

// Whether the formula names nothing that the role does not see, of what is on the model now.
Result<bool> sees_all_of(store::Store& store, Role role, ModelId model_id,
                         const std::string& expression);

}  // namespace strata::app
