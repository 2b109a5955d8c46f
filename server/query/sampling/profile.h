#pragma once

#include <span>
#include <vector>

#include "query/sampling/values.h"

namespace strata::mesh {
class RolloutRays;
}

namespace strata::query {

constexpr std::size_t kMaxProfileSamples = 10'000;

// The surface along a line.
struct Profile {
  struct Sample {
    // distance from the beginning along the surface, in model units, without the gaps where the
    // line leaves the surface
    double along = 0;
    SurfacePoint point;
  };
  // a sample that misses the surface has no hit, and the distance of the previous sample
  std::vector<Sample> samples;
  double length = 0;  // model units
};

// Samples the nearest surface points along a line through `places`, in steps of at most `step`
// (model units). More than kMaxProfileSamples are an `invalid` error at `step_mm`.
Result<Profile> profile_near(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             std::span<const glm::dvec3> places, double step,
                             const std::vector<LayerView>& layers);
// Samples the surface that a camera sees along a line in its window, at each pixel of the line. The
// origin of the window is at the top left. A line of more than kMaxProfileSamples pixels is an
// `invalid` error at `path`.
Result<Profile> profile_seen(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             const Camera& camera, std::span<const glm::dvec2> path,
                             const std::vector<LayerView>& layers);

// Samples the surface that an unrolled sheet shows along a line on it, in steps of at most `step`
// (model units). `origin` is that of the geometry of the rays. More than kMaxProfileSamples are an
// `invalid` error at `step_mm`.
Result<Profile> profile_unrolled(const mesh::RolloutRays& rays, const glm::dvec3& origin,
                                 std::span<const glm::dvec2> path, double step,
                                 const std::vector<LayerView>& layers);

}  // namespace strata::query
