#pragma once

#include <span>
#include <vector>

#include "query/sampling/values.h"

namespace strata::query {

constexpr std::size_t kMaxProfileSamples = 10'000;

// The surface along a line.
struct Profile {
  struct Sample {
    // distance from the beginning along the surface, model units; gaps where the line leaves the
    // surface are not counted
    double along = 0;
    SurfacePoint point;
  };
  // samples that miss the surface have no hit, and the distance of the sample before
  std::vector<Sample> samples;
  double length = 0;  // model units
};

// Samples the nearest surface point along a line through `places`, in steps of at most `step`
// (model units). Refused (invalid, `step_mm`): more than kMaxProfileSamples.
Result<Profile> profile_near(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             std::span<const glm::dvec3> places, double step,
                             const std::vector<LayerView>& layers);
// Samples the surface seen by a camera under a line of its window (pixels, origin top left), at
// each pixel of the line. Refused (invalid, `path`): a line of more than kMaxProfileSamples pixels.
Result<Profile> profile_seen(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             const Camera& camera, std::span<const glm::dvec2> path,
                             const std::vector<LayerView>& layers);

}  // namespace strata::query
