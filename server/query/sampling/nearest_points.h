#pragma once

#include <span>
#include <vector>

#include "query/sampling/values.h"

namespace strata::query {

// nearest_point of each, in their order, whatever that is: they are looked for along a curve
// through space, each from the answer of the one before.
std::vector<SurfacePoint> nearest_points(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                         std::span<const glm::dvec3> world_points,
                                         const std::vector<LayerView>& layers, int threads);

}  // namespace strata::query
