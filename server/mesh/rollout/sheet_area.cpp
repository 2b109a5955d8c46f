#include "mesh/rollout/sheet_area.h"

#include <algorithm>
#include <limits>

#include "domain/people/question.h"

namespace strata::mesh {

double SheetArea::Segment::distance(const glm::dvec2& point) const {
  const glm::dvec2 along = to - from, beyond = point - from;
  const double squared = glm::dot(along, along);
  const double share = squared > 0 ? std::clamp(glm::dot(beyond, along) / squared, 0.0, 1.0) : 0;
  return glm::length(beyond - share * along);
}

SheetArea::SheetArea(const std::vector<std::vector<glm::dvec2>>& polygons,
                     const std::vector<Stroke>& strokes)
    : low_(std::numeric_limits<double>::infinity()), high_(-low_) {
  for (const Stroke& stroke : strokes)
    for (std::size_t i = 0; i < stroke.path.size(); ++i) {
      const glm::dvec2& to = stroke.path[i];
      segments_.push_back({stroke.path[i == 0 ? 0 : i - 1], to, stroke.radius});
      low_ = glm::min(low_, to - stroke.radius);
      high_ = glm::max(high_, to + stroke.radius);
    }
  if (!segments_.empty()) sort_into_cells();
  for (const auto& polygon : polygons) {
    check_question();
    polygons_.emplace_back(std::vector<std::vector<glm::dvec2>>{polygon});
    low_ = glm::min(low_, polygons_.back().low());
    high_ = glm::max(high_, polygons_.back().high());
  }
}

void SheetArea::sort_into_cells() {
  strokes_low_ = low_;
  cell_size_ = (high_ - low_) / double{kSide};
  is_covered_.assign(std::size_t{kSide} * kSide, 0);
  cells_.resize(std::size_t{kSide} * kSide);
  const double to_corner = glm::length(cell_size_) / 2;
  for (std::uint32_t i = 0; i < segments_.size(); ++i) {
    if (i % 256 == 0) check_question();
    const Segment& segment = segments_[i];
    for (std::uint32_t cell = 0; cell < kSide * kSide; ++cell) {
      if (is_covered_[cell] != 0) continue;
      const glm::dvec2 center =
          strokes_low_ + cell_size_ * (glm::dvec2(glm::uvec2(cell % kSide, cell / kSide)) + 0.5);
      const double distance = segment.distance(center);
      if (distance > segment.radius + to_corner) continue;
      if (distance <= segment.radius - to_corner) {
        is_covered_[cell] = 1;
        cells_[cell] = {};
      } else {
        cells_[cell].push_back(i);
      }
    }
  }
}

bool SheetArea::under_stroke(const glm::dvec2& point) const {
  const glm::dvec2 cell = (point - strokes_low_) / cell_size_;
  if (!(cell.x >= 0 && cell.y >= 0 && cell.x <= kSide && cell.y <= kSide)) return false;
  const auto column = std::min(static_cast<std::uint32_t>(cell.x), kSide - 1),
             row = std::min(static_cast<std::uint32_t>(cell.y), kSide - 1);
  const std::size_t index = row * kSide + column;
  return is_covered_[index] != 0 || std::ranges::any_of(cells_[index], [&](std::uint32_t i) {
           return segments_[i].distance(point) <= segments_[i].radius;
         });
}

bool SheetArea::contains(const glm::dvec2& point) const {
  if (!segments_.empty() && under_stroke(point)) return true;
  return std::ranges::any_of(polygons_,
                             [&](const PolygonArea& polygon) { return polygon.contains(point); });
}

}  // namespace strata::mesh
