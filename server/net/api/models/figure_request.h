#pragma once

#include "app/figures/figures.h"
#include "net/api/route_help.h"

namespace strata::net {

// Reads the figure from the request body. Refuses (422) a view together with settings that it
// replaces, two directions, a normal without a direction, labels for a layer without keys, and a
// rollout together with settings that have no effect on it.
Result<app::FigureRequest> read_figure_request(const RouteContext& context, const Request& request);

}  // namespace strata::net
