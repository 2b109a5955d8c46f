#pragma once

#include <string_view>

#include "core/error.h"

namespace strata {

inline constexpr int kDeepestXml = 200;  // nested elements

// Rejects input that is dangerous for XML parsers, without parsing it. Rejects elements that are
// nested deeper than kDeepestXml, because parsers need quadratic time or more for them. Rejects
// entities that contain anything except plain text, because they can expand to a huge text, or
// refer to files and addresses. The parser reports other mistakes. The Error describes the mistake.
Result<void> check_xml_bounds(std::string_view text);

}  // namespace strata
