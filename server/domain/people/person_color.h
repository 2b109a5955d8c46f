#pragma once

#include <cstdint>
#include <string_view>

#include "core/ids.h"

namespace strata {

// Returns a person's color, as #rrggbb. It depends only on the account's id, so it is the same for
// everybody, everywhere and always. Dark enough for white letters (contrast 4.5 or more).
// Successive accounts differ, also for color-blind people; colors repeat from the 13th account on.
std::string_view person_color(PersonId account);

// For names without an account, such as those in the journal of another server.
inline constexpr std::string_view kNobodysColor = "#5f6668";

}  // namespace strata
