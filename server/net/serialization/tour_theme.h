#pragma once

#include <set>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::net {

// Refuses (invalid) colors that are hard to read on a kiosk. The text of the mode needs a contrast
// of at least 7:1 with the background, and the accent color one of at least 3:1. The page derives
// its other colors from these two (web-client/src/domain/tour-theme.ts).
Result<void> check_theme_colors(const protocol::TourTheme& theme);

}  // namespace strata::net
