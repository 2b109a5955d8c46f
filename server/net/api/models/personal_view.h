#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// What somebody keeps of how they show the layers of a model: the protocol's PersonalView, of what
// is there for their role. Blocks.
Result<nlohmann::json> personal_view(store::Store& store, const std::string& user, Role role,
                                     const room::Room& room);

}  // namespace strata::net
