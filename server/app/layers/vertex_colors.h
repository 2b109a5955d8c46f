#pragma once

#include "app/services.h"
#include "core/memory_ledger.h"
#include "query/sampling/values.h"
#include "query/sampling/vertex_colors.h"
#include "room/room.h"

namespace strata::app {

// The colours of a model's vertices with these layers over them, bottom to top, and `tiles` of
// each. Of the photos lie below those that are visible. `memory` holds what the colours take, for
// as long as they live. Refused: a palette by a column that the role does not see (422), a photo
// that there is no memory for (503). Blocks.
struct ComposedVertices {
  query::VertexColors colors;
  MemoryLedger::Share memory;
};
Result<ComposedVertices> compose_vertices(const Services& services, room::Room& room, Role role,
                                          const std::vector<query::LayerView>& bottom_to_top);

}  // namespace strata::app
