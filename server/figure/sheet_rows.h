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

// The whole sheet as pixels, drawn some rows at a time: `take` gets each row in turn, RGB8, and
// says whether to go on. False: it was told to stop, or cancelled.
bool sheet_rows(const Sheet& sheet, const Picture& drawing, int dpi, Progress& progress,
                const std::function<bool(std::span<const std::uint8_t> rgb)>& take);

}  // namespace strata::figure
