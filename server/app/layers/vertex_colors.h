#pragma once

#include "app/services.h"
#include "core/memory_ledger.h"
#include "query/sampling/values.h"
#include "query/sampling/vertex_colors.h"
#include "room/room.h"

namespace strata::app {

// The vertex colors of a model: the visible surface images, and over them the layers in their order
// from bottom to top. `memory` is reserved for the colors as long as they exist. `compose_vertices`
// refuses a palette that uses a column invisible to the role (422), and an image that exceeds the
// memory limit (503). Blocks.
struct ComposedVertices {
  query::VertexColors colors;
  MemoryLedger::Share memory;
};
Result<ComposedVertices> compose_vertices(const Services& services, room::Room& room, Role role,
                                          const std::vector<query::LayerView>& bottom_to_top);

}  // namespace strata::app
