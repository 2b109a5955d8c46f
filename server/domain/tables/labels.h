#pragma once

#include <map>
#include <string>

namespace strata {

// What people call a thing, or say of it, by language tag (BCP 47: "es", "pt-BR").
using Labels = std::map<std::string, std::string>;

}  // namespace strata
