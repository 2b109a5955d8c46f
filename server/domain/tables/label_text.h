#pragma once

#include <string_view>

#include "domain/tables/labels.h"

namespace strata {

// The label in a language, or else in the one that it is a kind of ("es" for "es-MX"); null: there
// is none. Tags are compared without regard to case.
const std::string* find_label(const Labels& labels, std::string_view language);
// The same, or the name that needs no language.
const std::string& label_or(const Labels& labels, std::string_view language,
                            const std::string& name);

}  // namespace strata
