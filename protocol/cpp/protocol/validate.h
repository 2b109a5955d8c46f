#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::protocol {

// Whether `json` is what the definition says. The Error (invalid) names the first wrong member
// ("camera.view[3]"), put after `field` when that is not empty, and says what belongs there.
// Thread-safe; each schema is built once, on first use.
Result<void> validate(Schema schema, const nlohmann::json& json, const std::string& field = {});

}  // namespace strata::protocol
