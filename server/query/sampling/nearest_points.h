#pragma once

#include <span>
#include <vector>

#include "query/sampling/values.h"

namespace strata::query {

// Returns nearest_point of each point, in the given order. The search follows a curve through
// space, and begins at each point with the result of the previous point.
std::vector<SurfacePoint> nearest_points(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                         std::span<const glm::dvec3> world_points,
                                         const std::vector<LayerView>& layers, int threads);

}  // namespace strata::query
