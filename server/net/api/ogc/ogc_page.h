#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace strata::net {

// Returns an OGC document as an HTML page: its title and description, the collections or the
// conformance classes that it lists, and its links. The page contains no scripts.
std::string ogc_page(const nlohmann::json& document);

}  // namespace strata::net
