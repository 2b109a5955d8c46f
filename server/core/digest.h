#pragma once

#include <string>
#include <string_view>

#include "core/uuid.h"

namespace strata {

std::string sha256_hex(std::string_view text);

// A UUID (version 8: hashed by SHA-256) that is the same for the same text: a caller's
// Idempotency-Key becomes the id of its edit.
Uuid uuid_of_text(std::string_view text);

// Takes the same time wherever the texts differ; for secrets.
bool equal_in_constant_time(std::string_view a, std::string_view b);

}  // namespace strata
