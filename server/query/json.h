#pragma once

#include <nlohmann/json.hpp>

#include "query/statistics.h"
#include "query/values.h"

namespace strata::query {

// The answers of position, pick and statistics (protocol/openapi.yaml). Off the model only `hit` is there.
nlohmann::json to_json(const SurfacePoint& point);
// Where nothing is valid, `min`, `max`, `mean` and `std` are absent; `keys` where there are none to tell.
nlohmann::json to_json(const Statistics& statistics);

}  // namespace strata::query
