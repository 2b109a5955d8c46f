#pragma once

#include <span>
#include <vector>

#include "query/sampling/values.h"

namespace strata::query {

constexpr std::size_t kMaxProfileSamples = 10'000;

// The surface along a line.
struct Profile {
  struct Sample {
    // from the beginning on the surface, model units; jumps where the line leaves the surface are
    // not counted
    double along = 0;
    SurfacePoint point;
  };
  // those that miss the surface hold no hit, and the distance of the one before
  std::vector<Sample> samples;
  double length = 0;  // model units
};

// From place to place in steps of at most `step` (model units): of each the nearest surface point.
// Refused (invalid, `step_mm`): more than kMaxProfileSamples.
Result<Profile> profile_near(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             std::span<const glm::dvec3> places, double step,
                             const std::vector<LayerView>& layers);
// What a camera sees under a line of its window (pixels, origin top left), at each pixel of its
// length. Refused (invalid, `path`): a line of more than kMaxProfileSamples pixels.
Result<Profile> profile_seen(const mesh::SearchTree& tree, const glm::dvec3& origin,
                             const Camera& camera, std::span<const glm::dvec2> path,
                             const std::vector<LayerView>& layers);

}  // namespace strata::query
