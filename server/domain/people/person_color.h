#pragma once

#include <cstdint>
#include <string_view>

#include "core/ids.h"

namespace strata {

// The colour of a person wherever they are shown, as #rrggbb: of their account's id alone, so that
// it is the same for everybody, everywhere and always. Dark enough for white letters (contrast 4.5
// and more). Accounts that follow each other differ, also to people who are colour-blind; from the
// 13th account on colours come again.
std::string_view person_color(PersonId account);

// Of names without an account, such as those in the journal of another server.
inline constexpr std::string_view kNobodysColor = "#5f6668";

}  // namespace strata
