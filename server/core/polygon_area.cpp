#include "core/polygon_area.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata {
namespace {

constexpr std::size_t kMaxRows = 4096;
// An edge is listed in each row that it crosses. Fewer rows keep the lists short.
constexpr double kRowsPerEdge = 32;  // in the mean

}  // namespace

PolygonArea::PolygonArea(const std::vector<std::vector<glm::dvec2>>& rings)
    : low_(std::numeric_limits<double>::infinity()),
      high_(-std::numeric_limits<double>::infinity()) {
  std::vector<Edge> edges;
  for (const auto& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
      low_ = glm::min(low_, a);
      high_ = glm::max(high_, a);
      if (a.y != b.y) edges.push_back(a.y < b.y ? Edge{a, b} : Edge{b, a});
    }
  double heights = 0;  // of all edges, in heights of the bounding box
  for (const Edge& edge : edges) heights += (edge.upper.y - edge.lower.y) / (high_.y - low_.y);
  auto rows = std::min(edges.size(), kMaxRows);
  if (heights > 0)
    rows = std::min(rows, static_cast<std::size_t>(kRowsPerEdge * double(edges.size()) / heights));
  rows_.assign(std::max<std::size_t>(rows, 1) + 1, 0);
  for (const Edge& edge : edges)
    for (int row = row_of(edge.lower.y); row <= row_of(edge.upper.y); ++row)
      ++rows_[static_cast<std::size_t>(row) + 1];
  for (std::size_t row = 1; row < rows_.size(); ++row) rows_[row] += rows_[row - 1];
  edges_.resize(rows_.back());
  auto next = rows_;
  for (const Edge& edge : edges)
    for (int row = row_of(edge.lower.y); row <= row_of(edge.upper.y); ++row)
      edges_[next[static_cast<std::size_t>(row)]++] = edge;
}

int PolygonArea::row_of(double y) const {
  const int rows = static_cast<int>(rows_.size()) - 1;
  const double height = high_.y - low_.y;
  if (!(height > 0)) return 0;
  return std::clamp(static_cast<int>((y - low_.y) / height * rows), 0, rows - 1);
}

bool PolygonArea::contains(const glm::dvec2& point) const {
  if (!(point.x >= low_.x && point.x <= high_.x && point.y >= low_.y && point.y <= high_.y))
    return false;
  bool inside = false;
  const auto row = static_cast<std::size_t>(row_of(point.y));
  for (std::size_t i = rows_[row]; i < rows_[row + 1]; ++i) {
    const Edge& edge = edges_[i];
    if (point.y < edge.lower.y || point.y >= edge.upper.y) continue;
    const glm::dvec2 along = edge.upper - edge.lower;
    // The point is on the left of the upward edge.
    if (along.x * (point.y - edge.lower.y) - along.y * (point.x - edge.lower.x) > 0)
      inside = !inside;
  }
  return inside;
}

}  // namespace strata
