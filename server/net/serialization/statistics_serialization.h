#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace strata::query {
struct Statistics;
struct CrossTable;
}  // namespace strata::query
namespace strata::room {
struct SelectedArea;
}

namespace strata::net {

nlohmann::json bounds_json(const glm::dvec3& low, const glm::dvec3& high);
nlohmann::json to_json(const query::Statistics& statistics);
nlohmann::json to_json(const room::SelectedArea& area);
nlohmann::json to_json(const query::CrossTable& table);
// Areas in m²: a line a row's value, a column a column's, `-` where a layer has none; the corner
// names both layers.
std::string cross_table_csv(const query::CrossTable& table, const std::string& rows,
                            const std::string& columns);

}  // namespace strata::net
