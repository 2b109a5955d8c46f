#pragma once

#include <string>
#include <vector>

#include "query/sampling/values.h"
#include "room/room.h"

namespace strata::app {

// Returns the layers without their content.
std::vector<query::LayerView> views_of(const std::vector<Layer>& layers);

// Returns the layers of the model in their current state. Only those with a slug in `read` have
// content.
Result<std::vector<query::LayerView>> views_read(room::Room& room,
                                                 const std::vector<std::string>& read);

}  // namespace strata::app
