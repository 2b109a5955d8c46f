#pragma once

#include "app/figures/figures.h"
#include "net/api/route_help.h"

namespace strata::net {

// The figure that the body of the request describes. Refused (422): a view and what stands in its
// place, two directions, a normal without one, labels of what holds no keys.
Result<app::FigureRequest> read_figure_request(const RouteContext& context, const Request& request);

}  // namespace strata::net
