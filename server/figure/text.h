#pragma once

#include <string>
#include <vector>

namespace strata::figure {

// Words in the sheet's typeface, by pango: any script, with fonts of the system where this one has
// no letters. Thread-safe.

inline constexpr const char* kTypeface = "DejaVu Sans";

double width_mm(const std::string& text, double size_mm, bool bold);
// Lines that are no wider; what has no place in `most_lines` is left out, and the last one ends
// with "…".
std::vector<std::string> wrapped(const std::string& text, double size_mm, bool bold,
                                 double width_mm, int most_lines);

}  // namespace strata::figure
