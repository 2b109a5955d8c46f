#pragma once

#include <nlohmann/json.hpp>

#include "app/maps/map_contents.h"

namespace strata::net {

// Converts to MapContents of the API.
nlohmann::json to_json(const app::MapContents& contents);

}  // namespace strata::net
