#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "protocol/messages.h"

namespace strata::app {
struct SurveyStatistics;
}
namespace strata::query {
struct Agreement;
struct Statistics;
struct CrossTable;
}  // namespace strata::query
namespace strata::room {
struct SelectedArea;
struct StatisticsOptions;
}  // namespace strata::room

namespace strata::net {

struct Request;

// Returns the parts in the query parameter `include`. Returns 422 for an unknown part.
Result<room::StatisticsOptions> statistics_options(const Request& request);
// Returns the parts in the member `include` of a body.
room::StatisticsOptions statistics_options(
    const std::optional<std::vector<protocol::StatisticsPart>>& include);

nlohmann::json bounds_json(const glm::dvec3& low, const glm::dvec3& high);
nlohmann::json to_json(const query::Statistics& statistics);
nlohmann::json to_json(const room::SelectedArea& area);
nlohmann::json to_json(const app::SurveyStatistics& statistics);
nlohmann::json to_json(const query::CrossTable& table);
nlohmann::json to_json(const query::Agreement& agreement);
// Returns areas in m² with one line for each value of `rows` and one column for each value of
// `columns`. `-` means texels where a layer has no value. The first cell names both layers.
std::string cross_table_csv(const query::CrossTable& table, const std::string& rows,
                            const std::string& columns);

}  // namespace strata::net
