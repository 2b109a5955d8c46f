#pragma once

#include <span>
#include <vector>

#include "domain/tables/surface_feature.h"
#include "jobs/transfer.h"

namespace strata::jobs {

struct TransferredFeatures {
  std::vector<SurfaceFeature> features;  // on the target
  // of those given: at least a part has no counterpart within the tolerance
  std::size_t lost_features = 0;
};

// Lines and points of the source as they lie on the target: each place becomes the nearest one of
// its surface. A line is parted where that is farther than the tolerance. Both models' world
// coordinates are taken to be of one system, in their own units.
TransferredFeatures transfer_features(std::span<const SurfaceFeature> features, const Model& source,
                                      const TransferTarget& target, double tolerance_mm);

}  // namespace strata::jobs
