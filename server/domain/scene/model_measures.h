#pragma once

#include <cmath>
#include <optional>

#include "domain/scene/model.h"

namespace strata {

// Returns whether lengths, heights and slopes mean the same in both states of a model. Otherwise,
// the computed layers are stale (store::Models::update).
inline bool same_measures(const Model& a, const Model& b) {
  return a.unit == b.unit && a.up == b.up;
}

// Returns the side of a texel of the mean area at any resolution, in model units, or nothing for
// models without texel sizes. It differs by less than 1 % from that of the texels on the surface,
// which need a map (mean_texel_size in query/regions/texel_discs).
inline std::optional<double> reported_texel_size(const AtlasReport& atlas, int resolution) {
  if (atlas.texel_sizes.empty() || !(atlas.texel_sizes.front().area_mean > 0)) return std::nullopt;
  const auto& measured = atlas.texel_sizes.front();
  return std::sqrt(measured.area_mean) * measured.resolution / resolution;
}

}  // namespace strata
