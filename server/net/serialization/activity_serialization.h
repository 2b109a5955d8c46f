#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "store/people/activity.h"

namespace strata::net {

nlohmann::json to_json(const store::Activity& line);

// "1777896570120000-7": where the next page or the next events begin.
std::string to_text(const store::ActivityPlace& place);
std::optional<store::ActivityPlace> place_of(std::string_view text);

}  // namespace strata::net
