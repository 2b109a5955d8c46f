#pragma once

#include "app/figures/figures.h"
#include "net/api/route_help.h"

namespace strata::net {

// Reads the figure from the body. Refuses (422): a view together with the settings that it
// replaces, two directions, a normal without a direction, labels of a layer without keys.
Result<app::FigureRequest> read_figure_request(const RouteContext& context, const Request& request);

}  // namespace strata::net
