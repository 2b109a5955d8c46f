#pragma once

#include <string>
#include <vector>

#include "report/document.h"

namespace strata::report {

// The page and the sizes of its content, which are the same in all file formats.

inline constexpr double kPageWidth_mm = 210, kPageHeight_mm = 297;  // A4, ISO 216
inline constexpr double kMargin_mm = 20, kTopMargin_mm = 25, kBottomMargin_mm = 25;
inline constexpr double kHeader_mm = 12, kFooter_mm = 12;  // from the edge of the paper
inline constexpr double kTextWidth_mm = kPageWidth_mm - 2 * kMargin_mm;
inline constexpr double kTextHeight_mm = kPageHeight_mm - kTopMargin_mm - kBottomMargin_mm;
// The rest of the page has room for a heading and a caption.
inline constexpr double kMaxPictureWidth_mm = kTextWidth_mm;
inline constexpr double kMaxPictureHeight_mm = kTextHeight_mm - 35;
inline constexpr double kMaxCellPictureHeight_mm = 100;
inline constexpr double kMaxLogoWidth_mm = 45, kMaxLogoHeight_mm = 20;
inline constexpr double kLabelWidth_mm = 45;    // of the title block
inline constexpr double kCellPadding_mm = 1.4;  // left and right
inline constexpr double kLeastColumn_mm = 6;

// Returns the widths of the columns, which fill the width of the text.
std::vector<double> column_widths_mm(const Table& table);

// Returns whether a table has a first row, which names its columns.
bool has_head(const Table& table);

// Returns whether a table has lines between and around its rows. A table that only arranges
// pictures has none.
bool has_rules(const Table& table);

struct ShownSize {
  double width_mm = 0, height_mm = 0;
  double scale = 1;  // below 1 if the picture is reduced
};
// Returns the size of a picture of `width` × `height` pixels on paper.
ShownSize shown_size(double width_mm, int width, int height, double most_width_mm,
                     double most_height_mm);

// Returns the caption of a picture. Adds a note if the picture is reduced.
std::string caption_of(const Picture& picture, const ShownSize& size, const Wording& wording);

}  // namespace strata::report
