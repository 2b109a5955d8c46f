#pragma once

#include <nlohmann/json.hpp>

#include "store/people/audit.h"

namespace strata::net {

nlohmann::json to_json(const store::AuditRow& row);
// Returns the row as one line of JSON, with the line feed.
std::string json_line(const store::AuditRow& row);

}  // namespace strata::net
