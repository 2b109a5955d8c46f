#include "jobs/transfer_features.h"

#include "mesh/surface/geometry.h"
#include "mesh/surface/search_tree.h"

namespace strata::jobs {

TransferredFeatures transfer_features(std::span<const SurfaceFeature> features, const Model& source,
                                      const TransferTarget& target, double tolerance_mm) {
  const double scale = source.metres() / target.model.metres();
  const auto farthest = static_cast<float>(tolerance_mm / 1000 / target.model.metres());
  const glm::dvec3& origin = target.geometry->origin;
  TransferredFeatures found;
  for (const SurfaceFeature& feature : features) {
    const std::size_t least = feature.places.size() == 1 ? 1 : 2;
    SurfaceFeature part{target.model.id, {}};
    bool is_whole = true;
    const auto end_part = [&] {
      if (part.places.size() >= least && (least == 1 || length_of(part) > 0))
        found.features.push_back(part);
      part.places.clear();
    };
    for (const glm::dvec3& place : feature.places) {
      if (const auto hit = target.tree->nearest(glm::vec3(place * scale - origin), farthest)) {
        part.places.push_back(glm::dvec3(hit->position) + origin);
      } else {
        is_whole = false;
        end_part();
      }
    }
    end_part();
    if (!is_whole) ++found.lost_features;
  }
  return found;
}

}  // namespace strata::jobs
