#pragma once

#include "report/document.h"

namespace strata::report {

// The look of the texts, which is the same in all file formats. Lengths are points.

struct TextStyle {
  double size_pt = 10;
  bool bold = false;
  Color color{0x1f, 0x24, 0x2a};
  double line_spacing = 1.15;  // of the height of the font
  double before_pt = 0, after_pt = 0;
};

inline constexpr Color kInk{0x1f, 0x24, 0x2a}, kQuietInk{0x5b, 0x65, 0x70};
inline constexpr Color kRule{0x1f, 0x24, 0x2a}, kHairline{0xc4, 0xca, 0xd1};
inline constexpr double kRule_pt = 0.75, kHairline_pt = 0.5;

inline constexpr TextStyle kTitle{20, true, kInk, 1.05, 0, 3};
inline constexpr TextStyle kSubject{11.5, false, kQuietInk, 1.1, 0, 0};
inline constexpr TextStyle kLabel{9, false, kQuietInk, 1.15, 1.5, 1.5};
inline constexpr TextStyle kValue{9.5, false, kInk, 1.15, 1.5, 1.5};
inline constexpr TextStyle kHeadings[] = {{14, true, kInk, 1.1, 18, 6},
                                          {11.5, true, kInk, 1.1, 14, 4},
                                          {10, true, kQuietInk, 1.1, 10, 3}};
inline constexpr TextStyle kBody{10, false, kInk, 1.2, 0, 6};
inline constexpr TextStyle kListItem{10, false, kInk, 1.2, 0, 3};
inline constexpr TextStyle kTableHead{8.5, true, kInk, 1.1, 2.5, 2.5};
inline constexpr TextStyle kTableText{8.5, false, kInk, 1.1, 2.5, 2.5};
inline constexpr TextStyle kTableTotal{8.5, true, kInk, 1.1, 2.5, 2.5};
inline constexpr TextStyle kCaption{8.5, false, kQuietInk, 1.15, 0, 0};
inline constexpr TextStyle kHeaderText{8, false, kQuietInk, 1.1, 0, 0};

inline constexpr double kAboveTable_pt = 6, kBelowTable_pt = 12;  // a caption belongs to the table
inline constexpr double kAbovePicture_pt = 6, kBelowPicture_pt = 12;
inline constexpr double kCaptionGap_pt = 4;  // between a caption and its table or picture
inline constexpr double kListIndent_pt = 14;
inline constexpr double kSwatchWidth_mm = 5, kSwatchHeight_mm = 2.6;

}  // namespace strata::report
