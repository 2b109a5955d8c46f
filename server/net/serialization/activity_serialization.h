#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "store/people/activity.h"

namespace strata::net {

nlohmann::json to_json(const store::Activity& line);

// Converts a position in the activity to text such as "1777896570120000-7". The next page or the
// next events begin there.
std::string to_text(const store::ActivityPlace& place);
std::optional<store::ActivityPlace> place_of(std::string_view text);

}  // namespace strata::net
