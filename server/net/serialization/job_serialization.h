#pragma once

#include <nlohmann/json.hpp>

namespace strata::jobs {
struct JobStatus;
}

namespace strata::net {

nlohmann::json to_json(const jobs::JobStatus& job);

}  // namespace strata::net
