#pragma once

#include "app/figures/figures.h"
#include "net/api/route_help.h"
#include "protocol/messages.h"

namespace strata::net {

// Reads the figure, or the sheet of several views, from the request body. Refuses (422) a view
// together with settings that it replaces, two directions, a normal without a direction, labels for
// a layer without keys, a rollout together with settings that have no effect on it, outlines that
// the format or the rollout cannot have, a tolerance without outlines, and several views together
// with settings of a single one.
Result<app::FigureRequest> read_figure_request(const RouteContext& context, const Request& request);

// As read_figure_request, for a body that is a part of another request. The names in the legend
// have no language.
Result<app::FigureRequest> figure_request(const RouteContext& context, const Request& request,
                                          std::shared_ptr<room::Room> room,
                                          const protocol::FigureRequest& body);

}  // namespace strata::net
