#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Returns the layer settings that a user has stored for a model, as PersonalView of the protocol.
// Contains only entities that the role can see. Blocks.
Result<nlohmann::json> personal_view(store::Store& store, const std::string& user, Role role,
                                     const room::Room& room);

}  // namespace strata::net
