#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "domain/scene/model.h"
#include "protocol/parse.h"

namespace strata {
struct Layer;
}
namespace strata::query {
struct Profile;
struct SurfacePoint;
}  // namespace strata::query

namespace strata::net {

// Returns the parameters of CoverageJSON: the meaning of the values of the layers.
nlohmann::json coverage_parameters(const std::vector<Layer>& layers);
protocol::SurfacePoint to_protocol(const query::SurfacePoint& point);
protocol::Picked to_picked(const query::SurfacePoint& point, const std::optional<std::string>& id);
nlohmann::json to_json(const query::Profile& profile, Unit unit);
nlohmann::json point_coverage(const query::SurfacePoint& point, const std::vector<Layer>& layers,
                              const Model& model);
// Write many points in the formats of GET …/position and POST …/positions. `layers` contains the
// slugs of the layers, with one column for each.
std::string points_csv(const std::vector<query::SurfacePoint>& points,
                       const std::vector<std::string>& layers);
// Adds a column `along_mm` before the columns of `points_csv`.
std::string profile_csv(const query::Profile& profile, Unit unit,
                        const std::vector<std::string>& layers);

}  // namespace strata::net
