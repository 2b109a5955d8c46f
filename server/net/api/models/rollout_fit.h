#pragma once

#include "core/error.h"
#include "mesh/rollout/fit_developed_surface.h"
#include "protocol/messages.h"

namespace strata::net {

// Reads what a request says about the surface of a rollout. Refuses (422) an axis without a
// direction, and members that have no effect without others.
Result<mesh::FitRequest> read_fit(const protocol::FigureRollout& body);

}  // namespace strata::net
