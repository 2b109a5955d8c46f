#pragma once

#include <set>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::net {

// Refuses (invalid) colors with which visitors could not read a kiosk: the text of the mode needs a
// contrast of 7:1 with the background, and the accent color one of 3:1. The page derives its other
// colors from these two (web-client/src/domain/tour-theme.ts).
Result<void> check_theme_colors(const protocol::TourTheme& theme);

}  // namespace strata::net
