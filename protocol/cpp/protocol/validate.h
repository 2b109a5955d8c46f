#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::protocol {

// Checks `json` against the definition. The Error (invalid) names the first wrong member
// ("camera.view[3]"), after `field` if that is not empty, and describes the expected value.
// Thread-safe; each schema is built once, on first use.
Result<void> validate(Schema schema, const nlohmann::json& json, const std::string& field = {});

}  // namespace strata::protocol
