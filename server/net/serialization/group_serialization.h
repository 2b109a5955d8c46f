#pragma once

#include <nlohmann/json.hpp>

namespace strata::store {
struct ProjectGroup;
}

namespace strata::net {

nlohmann::json to_json(const store::ProjectGroup& group);

}  // namespace strata::net
