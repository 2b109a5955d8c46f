#pragma once

#include <map>
#include <string>

namespace strata {

// The names or descriptions of an entity by language tag (BCP 47: "es", "pt-BR").
using Labels = std::map<std::string, std::string>;

}  // namespace strata
