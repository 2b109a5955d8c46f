#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Returns a user's stored settings of how the layers of a model are shown, as the protocol's
// PersonalView. Contains only entities that their role can see. Blocks.
Result<nlohmann::json> personal_view(store::Store& store, const std::string& user, Role role,
                                     const room::Room& room);

}  // namespace strata::net
