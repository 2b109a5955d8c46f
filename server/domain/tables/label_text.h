#pragma once

#include <string_view>

#include "domain/tables/labels.h"

namespace strata {

// Returns the label in a language, or in its base language ("es" for "es-MX"). Returns null without
// such a label. Tags are compared without regard to case.
const std::string* find_label(const Labels& labels, std::string_view language);
// Returns the label, or else `name`, which does not depend on the language.
const std::string& label_or(const Labels& labels, std::string_view language,
                            const std::string& name);

}  // namespace strata
