#pragma once

#include <string>
#include <vector>

namespace strata::figure {

// Text in the sheet's typeface, by pango: any script, with the system's fonts for missing letters.
// Thread-safe.

inline constexpr const char* kTypeface = "DejaVu Sans";

double width_mm(const std::string& text, double size_mm, bool bold);
// Breaks a text into lines of at most this width; cuts it after `most_lines`, and ends the last one
// with "…".
std::vector<std::string> wrapped(const std::string& text, double size_mm, bool bold,
                                 double width_mm, int most_lines);

}  // namespace strata::figure
