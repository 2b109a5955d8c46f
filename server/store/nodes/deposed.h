#pragma once

#include <cstdint>
#include <optional>

#include "core/error.h"
#include "core/ids.h"
#include "store/pg/pg.h"

namespace strata::store {

// Returns the error `moved` if the newest epoch of the model differs, and nothing if the epoch is
// the newest or if there is no such model. If the owner has a lease, the error has its address.
Result<std::optional<Error>> deposed_problem(PgConnection& connection, ModelId model,
                                             std::int64_t epoch);

}  // namespace strata::store
