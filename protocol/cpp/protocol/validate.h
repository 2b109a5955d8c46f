#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::protocol {

// Checks `json` against the definition. An `invalid` error describes the expected value and names
// the first invalid member ("camera.view[3]"). If `field` is not empty, the name begins with it.
// Thread-safe. Each schema is built once, at the first use.
Result<void> validate(Schema schema, const nlohmann::json& json, const std::string& field = {});

}  // namespace strata::protocol
