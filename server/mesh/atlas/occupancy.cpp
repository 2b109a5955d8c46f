#include "mesh/atlas/occupancy.h"

namespace strata::mesh {

bool Occupancy::holds(glm::vec2 a, glm::vec2 b, glm::vec2 c) const {
  const float half = static_cast<float>(side_) / 2;
  const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  return low.x > 1 - half && low.y > 1 - half && high.x < half - 1 && high.y < half - 1;
}

bool Occupancy::find_spans(glm::vec2 a, glm::vec2 b, glm::vec2 c, Overlap overlap) {
  const float half = static_cast<float>(side_) / 2;
  const auto snap = [&](glm::vec2 p) { return snap_to_subtexels(p.x + half, p.y + half); };
  const CoverageRaster raster(snap(a), snap(b), snap(c));
  spans_.clear();
  return raster.for_each_span(0, side_, 0, side_, [&](int y, int begin, int end) {
    const std::uint32_t row = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(side_);
    if (overlap == Overlap::refuse)
      for (std::uint32_t i = row + begin; i < row + end; ++i)
        if (stamps_[i] == stamp_) return false;
    spans_.push_back({row + begin, row + end});
    return true;
  });
}

bool Occupancy::is_free(glm::vec2 a, glm::vec2 b, glm::vec2 c) {
  return holds(a, b, c) && find_spans(a, b, c, Overlap::refuse);
}

bool Occupancy::claim(glm::vec2 a, glm::vec2 b, glm::vec2 c, Overlap overlap) {
  if (!holds(a, b, c)) {
    if (overlap == Overlap::refuse) return false;
    // Coordinates far outside the window would overflow integers. Texels outside are not recorded.
    const glm::vec2 limit(8.f * static_cast<float>(side_));
    a = glm::clamp(a, -limit, limit), b = glm::clamp(b, -limit, limit),
    c = glm::clamp(c, -limit, limit);
  }
  if (!find_spans(a, b, c, overlap)) return false;
  for (const Span& span : spans_)
    for (std::uint32_t i = span.begin; i < span.end; ++i) stamps_[i] = stamp_;
  return true;
}

}  // namespace strata::mesh
