#pragma once

#include "net/api/routes.h"
#include "net/byte_budget.h"

namespace strata::net {

// Answers what a map file holds, before anybody paints it: attributes of polygons; size, bands,
// place and colours of a picture.
Result<Response> map_contents(const RouteContext& context, ByteBudget& budget,
                              const Request& request);

}  // namespace strata::net
