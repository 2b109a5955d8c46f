#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// 428 (RFC 6585): the change names no version in If-Match, of something that has versions, in a
// project that demands it.
Result<void> check_precondition(const RouteContext& context, const Request& request,
                                const Route& route);

}  // namespace strata::net
