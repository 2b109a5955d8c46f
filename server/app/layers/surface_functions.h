#pragma once

#include <vector>

#include "app/services.h"
#include "core/memory_ledger.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "expression/surface_functions.h"
#include "query/sampling/values.h"
#include "room/room.h"

namespace strata::app {

// Reserves the memory for compute_surface_functions. Keep it until the formula has been evaluated.
Result<MemoryLedger::Share> reserve_surface_functions(const Services& services, room::Room& room,
                                                      const Layer& layer,
                                                      const query::SurfaceFormula& formula);

// Computes the functions along the surface of the formula of a computed layer, at the texels of the
// layer. They read the layers and records in their current state, with the rules for formulas of
// computed layers (room::bind_for_layer). `shapes` are the shape values that they read, as layers
// `surface.…`. Adds the values to `shapes`, in layers with the slugs of the functions. Each
// function is a step of `progress`, which begins at step `first` of `steps`. Blocks. Fails when
// cancelled.
Result<void> compute_surface_functions(const Services& services, room::Room& room,
                                       const Layer& layer, const query::SurfaceFormula& formula,
                                       const Author& author, std::vector<query::LayerView>& shapes,
                                       Progress& progress, std::size_t first, std::size_t steps);

}  // namespace strata::app
