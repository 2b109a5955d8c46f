#pragma once

#include <string>

namespace strata {

// Removes the characters that XML or cairo do not allow, and other characters without a meaning in
// a document: control characters except tab and line feed, and the last two code points of the
// first plane. Replaces invalid bytes by U+FFFD.
std::string printable(const std::string& text);

}  // namespace strata
