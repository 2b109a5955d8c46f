#pragma once

#include <string_view>

#include "core/error.h"

namespace strata {

inline constexpr int kDeepestXml = 200;  // nested elements

// Refuses input that is dangerous for XML parsers, without parsing it: elements that are nested
// deeper than kDeepestXml (parsers take quadratic time or more for those), and entities that
// contain anything except plain text (which can grow, or name files and addresses). The parser
// reports other mistakes. The text of an Error names the mistake.
Result<void> check_xml_bounds(std::string_view text);

}  // namespace strata
