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

// Renders the whole sheet as pixels, in bands of rows. Calls `take` with each row as RGB8, from top
// to bottom. `take` returns false to stop. Returns false if `take` stopped or the job was canceled.
bool sheet_rows(const Sheet& sheet, const Picture& drawing, int dpi, Progress& progress,
                const std::function<bool(std::span<const std::uint8_t> rgb)>& take);

}  // namespace strata::figure
