#include "query/maps/flat_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata::query {
namespace {

constexpr int kMaxCells = 512;  // cells per side
// limit for the entries of the grid, because an area that covers everything is in every cell
constexpr std::size_t kMaxEntries = std::size_t{1} << 22;

}  // namespace

FlatMap::FlatMap(std::vector<MapArea> areas)
    : areas_(std::move(areas)), low_(std::numeric_limits<double>::infinity()), size_(0) {
  glm::dvec2 high(-std::numeric_limits<double>::infinity());
  for (const MapArea& each : areas_) {
    low_ = glm::min(low_, each.area.low());
    high = glm::max(high, each.area.high());
  }
  size_ = high - low_;
  side_ =
      std::clamp(static_cast<int>(2 * std::sqrt(static_cast<double>(areas_.size()))), 1, kMaxCells);
  while (side_ > 1 && entries() > kMaxEntries) side_ /= 2;

  begins_.assign(static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) + 1, 0);
  const auto each_cell = [&](const PolygonArea& area, const auto& take) {
    const Cells cells = cells_of(area);
    for (int y = cells.bottom; y <= cells.top; ++y)
      for (int x = cells.left; x <= cells.right; ++x) take(static_cast<std::size_t>(y * side_ + x));
  };
  for (const MapArea& each : areas_)
    each_cell(each.area, [&](std::size_t at) { ++begins_[at + 1]; });
  for (std::size_t at = 1; at < begins_.size(); ++at) begins_[at] += begins_[at - 1];
  in_cell_.resize(begins_.back());
  auto next = begins_;
  for (std::size_t i = 0; i < areas_.size(); ++i)
    each_cell(areas_[i].area,
              [&](std::size_t at) { in_cell_[next[at]++] = static_cast<std::uint32_t>(i); });
}

int FlatMap::cell(double at, double low, double size) const {
  if (!(size > 0)) return 0;
  return std::clamp(static_cast<int>((at - low) / size * side_), 0, side_ - 1);
}

FlatMap::Cells FlatMap::cells_of(const PolygonArea& area) const {
  return {cell(area.low().x, low_.x, size_.x), cell(area.high().x, low_.x, size_.x),
          cell(area.low().y, low_.y, size_.y), cell(area.high().y, low_.y, size_.y)};
}

std::size_t FlatMap::entries() const {
  std::size_t sum = 0;
  for (const MapArea& each : areas_) {
    const Cells cells = cells_of(each.area);
    sum += static_cast<std::size_t>(cells.right - cells.left + 1) *
           static_cast<std::size_t>(cells.top - cells.bottom + 1);
  }
  return sum;
}

std::optional<double> FlatMap::value_at(const glm::dvec2& point) const {
  const glm::dvec2 inside = point - low_;
  if (!(inside.x >= 0 && inside.y >= 0 && inside.x <= size_.x && inside.y <= size_.y))
    return std::nullopt;
  const auto at = static_cast<std::size_t>(cell(point.y, low_.y, size_.y) * side_ +
                                           cell(point.x, low_.x, size_.x));
  for (std::size_t i = begins_[at + 1]; i > begins_[at]; --i) {
    const MapArea& candidate = areas_[in_cell_[i - 1]];
    if (candidate.area.contains(point)) return candidate.value;
  }
  return std::nullopt;
}

}  // namespace strata::query
