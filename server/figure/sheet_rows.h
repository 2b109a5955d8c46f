#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/progress.h"
#include "figure/sheet.h"
#include "media/picture.h"

namespace strata::figure {

struct SheetPixels {
  int width = 0, height = 0;
};
SheetPixels pixels_of(const Sheet& sheet, int dpi);

// Renders the whole sheet as pixels, some rows at a time: `take` receives each row in turn as RGB8,
// and returns false to stop. False: stopped or canceled.
bool sheet_rows(const Sheet& sheet, const Picture& drawing, int dpi, Progress& progress,
                const std::function<bool(std::span<const std::uint8_t> rgb)>& take);

}  // namespace strata::figure
