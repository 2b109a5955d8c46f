#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "mesh/surface/search_tree.h"
#include "query/sampling/values.h"

namespace strata::query {

// The point of a hit. `hit` and `origin` are of the same geometry.
SurfacePoint surface_point(const mesh::SearchTree::Hit& hit, const glm::dvec3& origin,
                           const std::vector<LayerView>& layers);
SurfacePoint off_the_model(const std::vector<LayerView>& layers);  // a point without a hit

}  // namespace strata::query
