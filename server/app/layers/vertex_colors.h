#pragma once

#include "app/services.h"
#include "core/memory_ledger.h"
#include "query/sampling/values.h"
#include "query/sampling/vertex_colors.h"
#include "room/room.h"

namespace strata::app {

// Returns the colors of a model's vertices under these layers, bottom to top, with the visible
// surface images below. `memory` is the share of the colors, held as long as they exist. Refuses a
// palette by a column that the role does not see (422), and an image that exceeds the memory limit
// (503). Blocks.
struct ComposedVertices {
  query::VertexColors colors;
  MemoryLedger::Share memory;
};
Result<ComposedVertices> compose_vertices(const Services& services, room::Room& room, Role role,
                                          const std::vector<query::LayerView>& bottom_to_top);

}  // namespace strata::app
