#pragma once

#include <set>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::net {

// Refuses (invalid) colors that are hard to read on a kiosk. The contrast with the background must
// be at least 7:1 for the mode's text color and 3:1 for the accent color. The page derives its
// other colors from these two (web-client/src/domain/tour-theme.ts).
Result<void> check_theme_colors(const protocol::TourTheme& theme);

}  // namespace strata::net
