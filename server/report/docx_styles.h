#pragma once

#include <string>

namespace strata::report {

// Returns the part word/styles.xml: the styles of style.h, with the language of the texts.
std::string docx_styles(const std::string& language);

}  // namespace strata::report
