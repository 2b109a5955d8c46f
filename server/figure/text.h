#pragma once

#include <string>
#include <vector>

namespace strata::figure {

// Text in the typeface of the sheet, laid out by Pango. Supports any script, with fonts of the
// system for missing letters. Thread-safe.

inline constexpr const char* kTypeface = "DejaVu Sans";

double width_mm(const std::string& text, double size_mm, bool bold);
// Splits a text into lines of at most `width_mm`. Cuts it after `most_lines` lines and then ends
// the last line with "…".
std::vector<std::string> wrapped(const std::string& text, double size_mm, bool bold,
                                 double width_mm, int most_lines);
// As wrapped(), but a line that ends with "…" is not wider than the others.
std::vector<std::string> fitted(const std::string& text, double size_mm, bool bold, double width_mm,
                                int most_lines);

}  // namespace strata::figure
