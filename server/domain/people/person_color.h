#pragma once

#include <cstdint>
#include <string_view>

#include "core/ids.h"

namespace strata {

// Returns the color of a user, as #rrggbb. The color depends only on the id of the account, so all
// users see the same color at all times. White letters are readable on it (contrast 4.5 or more).
// Successive accounts have different colors, also for color-blind users. The colors repeat after 12
// accounts.
std::string_view person_color(PersonId account);

// The color of names without an account, such as names in the journal of another server.
inline constexpr std::string_view kNobodysColor = "#5f6668";

}  // namespace strata
