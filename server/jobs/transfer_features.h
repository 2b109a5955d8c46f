#pragma once

#include <span>
#include <vector>

#include "domain/tables/surface_feature.h"
#include "jobs/transfer.h"

namespace strata::jobs {

struct TransferredFeatures {
  std::vector<SurfaceFeature> features;  // on the target
  // number of given features of which at least a part has no counterpart within the tolerance
  std::size_t lost_features = 0;
};

// Moves lines and points of the source to the target: each place moves to the nearest one of the
// target's surface. A line is split where that is farther than the tolerance. The world coordinates
// of both models must be of one system, each in its own units.
TransferredFeatures transfer_features(std::span<const SurfaceFeature> features, const Model& source,
                                      const TransferTarget& target, double tolerance_mm);

}  // namespace strata::jobs
