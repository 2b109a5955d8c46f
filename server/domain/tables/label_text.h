#pragma once

#include <string_view>

#include "domain/tables/labels.h"

namespace strata {

// Returns the label in a language or its base language ("es" for "es-MX"); null if there is no
// label. Tags are compared without regard to case.
const std::string* find_label(const Labels& labels, std::string_view language);
// The same, with the language-independent name as default.
const std::string& label_or(const Labels& labels, std::string_view language,
                            const std::string& name);

}  // namespace strata
