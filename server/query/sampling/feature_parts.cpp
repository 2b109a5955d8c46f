#include "query/sampling/feature_parts.h"

#include <limits>

namespace strata::query {

void find_parts(std::vector<KeyFeature>& features, const mesh::Geometry& geometry,
                const mesh::SearchTree& tree) {
  for (KeyFeature& each : features) {
    const auto hit = tree.nearest(glm::vec3(each.feature.places.front() - geometry.origin),
                                  std::numeric_limits<float>::infinity());
    if (hit) each.part = geometry.part_of(hit->triangle);
  }
}

}  // namespace strata::query
