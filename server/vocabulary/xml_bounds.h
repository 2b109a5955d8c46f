#pragma once

#include <string_view>

#include "core/error.h"

namespace strata {

inline constexpr int kDeepestXml = 200;  // elements within each other

// What a parser of XML should not be given, found without parsing it: elements that are nested
// deeper than kDeepestXml (parsers take quadratic time and more for those), and entities that hold
// anything but plain text (which grow, or name files and addresses). Other mistakes are the
// parser's to find. The text of an Error says what is wrong.
Result<void> check_xml_bounds(std::string_view text);

}  // namespace strata
