#pragma once

#include <span>
#include <vector>

#include "domain/tables/surface_feature.h"
#include "jobs/transfer.h"

namespace strata::jobs {

struct TransferredFeatures {
  std::vector<SurfaceFeature> features;  // features on the target
  // The number of given features with at least one part that has no counterpart within the
  // tolerance.
  std::size_t lost_features = 0;
};

// Moves lines and points of the source to the target. Each vertex moves to the nearest point of the
// target's surface. A line is split at vertices for which that point is farther than the tolerance.
// Both models must have the same world coordinate system.
// Each model may have its own unit.
TransferredFeatures transfer_features(std::span<const SurfaceFeature> features, const Model& source,
                                      const TransferTarget& target, double tolerance_mm);

}  // namespace strata::jobs
