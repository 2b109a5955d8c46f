#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Returns 428 (RFC 6585) if the change has no version in If-Match although the project requires one
// for entities with versions.
Result<void> check_precondition(const RouteContext& context, const Request& request,
                                const Route& route);

}  // namespace strata::net
