#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// 428 (RFC 6585): the change has no version in If-Match, although the entity has versions and the
// project requires them.
Result<void> check_precondition(const RouteContext& context, const Request& request,
                                const Route& route);

}  // namespace strata::net
