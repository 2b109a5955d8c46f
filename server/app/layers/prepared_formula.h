#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "app/services.h"
#include "core/memory_ledger.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "expression/expression.h"
#include "query/sampling/values.h"
#include "room/room.h"

namespace strata::app {

// The formula of a layer, with everything that is computed before the edit evaluates it.
struct PreparedFormula {
  Expression expression;                 // has names of `views` in place of functions
  std::vector<query::LayerView> views;   // shape values and functions along the surface
  std::optional<std::int64_t> sequence;  // of the state that the functions read
  MemoryLedger::Share memory;
};

// Computes the shape values and the functions along the surface that the formula of `layer` reads,
// at the resolution of the layer, which need not exist. Blocks. Fails when cancelled.
Result<PreparedFormula> prepare_formula(const Services& services, room::Room& room,
                                        const Layer& layer, const Author& author,
                                        Progress& progress);

}  // namespace strata::app
