#pragma once

#include <nlohmann/json.hpp>

#include "app/maps/map_contents.h"

namespace strata::net {

// Converts to the contract's MapContents.
nlohmann::json to_json(const app::MapContents& contents);

}  // namespace strata::net
