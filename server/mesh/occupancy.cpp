#include "mesh/occupancy.h"

namespace strata::mesh {

bool Occupancy::claim(glm::vec2 a, glm::vec2 b, glm::vec2 c, Overlap overlap) {
  const float half = static_cast<float>(side_) / 2;
  const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
  const bool is_inside = low.x > 1 - half && low.y > 1 - half && high.x < half - 1 && high.y < half - 1;
  if (!is_inside) {
    if (overlap == Overlap::refuse) return false;
    // Far outside the window coordinates would not fit integers; what is outside is not recorded anyway.
    const glm::vec2 limit(8.f * side_);
    a = glm::clamp(a, -limit, limit), b = glm::clamp(b, -limit, limit), c = glm::clamp(c, -limit, limit);
  }
  const auto snap = [&](glm::vec2 p) { return snap_to_subtexels(p.x + half, p.y + half); };
  const CoverageRaster raster(snap(a), snap(b), snap(c));
  spans_.clear();
  const bool is_free = raster.for_each_span(0, side_, 0, side_, [&](int y, int begin, int end) {
    const std::uint32_t row = static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(side_);
    if (overlap == Overlap::refuse)
      for (std::uint32_t i = row + begin; i < row + end; ++i)
        if (stamps_[i] == stamp_) return false;
    spans_.push_back({row + begin, row + end});
    return true;
  });
  if (!is_free) return false;
  for (const Span& span : spans_)
    for (std::uint32_t i = span.begin; i < span.end; ++i) stamps_[i] = stamp_;
  return true;
}

}  // namespace strata::mesh
