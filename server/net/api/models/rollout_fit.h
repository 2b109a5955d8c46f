#pragma once

#include <optional>

#include "core/error.h"
#include "mesh/rollout/fit_developed_surface.h"
#include "protocol/messages.h"

namespace strata::net {

// What a request says about the sheet of a rollout.
struct SheetRequest {
  mesh::FitRequest fit;
  std::optional<double> cut;  // in radians
};

// Refuses (422) an axis without a direction, and members that have no effect without others.
Result<SheetRequest> read_sheet(const protocol::FigureRollout& body);

// Reads the same members of another message.
template <class Body>
Result<SheetRequest> read_sheet(const Body& body) {
  return read_sheet(protocol::FigureRollout{body.axis, body.shape, body.radius, body.half_angle,
                                            body.side, body.cut});
}

}  // namespace strata::net
