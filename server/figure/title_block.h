#pragma once

#include <string>

#include "figure/sheet.h"

namespace strata::figure {

// The title block at the bottom right of a sheet, with the fields of ISO 7200.

struct TitleBlock {
  // The name of the field in small letters, and its text. A field without a text stays empty.
  struct Field {
    std::string label, text;
  };
  Field organization, project, object, title, author, checked_by, date, status, scale, number,
      sheet;
};

// A wide block has three rows and needs the width of a page. A compact block has five rows and fits
// next to other texts.
enum class BlockShape { wide, compact };
inline constexpr double kCompactBlock_mm = 120, kWideBlock_mm = 160;  // widths
double block_height_mm(BlockShape shape);

// Texts that do not fit in their fields end with "…". The title has up to two lines.
Group title_block_group(const TitleBlock& block, BlockShape shape, const glm::dvec2& corner,
                        double width);

}  // namespace strata::figure
