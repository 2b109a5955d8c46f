#include "query/statistics/border_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mesh/texels/surface_map.h"

namespace strata::query {

using mesh::kNoNeighbour;
using mesh::Way;

BorderLines::Walk BorderLines::walk_along(int dx, int dy) {
  const Way across = dx < 0 ? Way::left : Way::right, up = dy < 0 ? Way::lower : Way::upper;
  switch (std::abs(dx) * 10 + std::abs(dy)) {
    case 10: return {1, {{{across}}}, 1};
    case 1: return {1, {{{up}}}, 1};
    case 11: return {2, {{{across, up}, {up, across}}}, 2};
    case 21: return {3, {{{across, up, across}, {across, across, up}, {up, across, across}}}, 3};
    default: return {3, {{{up, across, up}, {up, up, across}, {across, up, up}}}, 3};
  }
}

BorderLines::BorderLines(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph)
    : map_(map), graph_(graph) {
  for (std::size_t k = 0; k < kDirections; ++k) {
    walks_[k] = walk_along(kDirection[k][0], kDirection[k][1]);
    walks_[k + kDirections] = walk_along(-kDirection[k][0], -kDirection[k][1]);
  }
}

glm::dvec3 BorderLines::place(std::uint32_t texel) const {
  return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
}

double BorderLines::Surroundings::weight(std::size_t direction) {
  if (!weights_) weights_ = weigh();
  return (*weights_)[direction % kDirections];
}

std::uint32_t BorderLines::Surroundings::beyond_seam(std::size_t direction) {
  if (reach().over_seam.empty()) return kNoNeighbour;
  const auto& [x, y] = sides();
  const auto [dx, dy] = kDirection[direction % kDirections];
  const glm::dvec3 way = (direction < kDirections ? 1.0 : -1.0) * (double(dx) * x + double(dy) * y);
  const glm::dvec3 here = lines_.place(texel_);
  double nearest = std::numeric_limits<double>::infinity();
  std::uint32_t found = kNoNeighbour;
  for (const std::uint32_t other : reach().over_seam) {
    const glm::dvec3 there = lines_.place(other) - here;
    // Where a seam ends at an open edge, this direction may lead to the seam or to the open
    // edge.
    if (is_at_open_edge() && glm::dot(there, way) < 0.5 * glm::length(there) * glm::length(way))
      continue;
    const double apart = glm::length(there - way);
    if (apart >= nearest) continue;
    nearest = apart;
    found = other;
  }
  return found;
}

const SeamReach& BorderLines::Surroundings::reach() {
  if (reach_) return *reach_;
  reach_.emplace();
  struct Reached {
    std::uint32_t texel;
    bool over;
  };
  std::vector<Reached> reached{{texel_, false}};
  std::size_t first = 0;
  for (int step = 0; step < 3; ++step) {
    const std::size_t last = reached.size();
    for (; first < last; ++first) {
      const Reached from = reached[first];
      mesh::for_each_neighbour(lines_.map_, lines_.graph_, from.texel, [&](std::uint32_t next) {
        if (std::ranges::find(reached, next, &Reached::texel) != reached.end()) return;
        reached.push_back({next, from.over || !are_beside(from.texel, next)});
      });
    }
  }
  for (const auto& [each, over] : reached) {
    if (over) reach_->over_seam.push_back(each);
    reach_->at_open_edge |= !over && (lines_.graph_.at_open_edge[each / 64] >> each % 64 & 1u) != 0;
  }
  return *reach_;
}

bool BorderLines::Surroundings::are_beside(std::uint32_t a, std::uint32_t b) const {
  return std::ranges::any_of(std::array{Way::right, Way::upper, Way::left, Way::lower},
                             [&](Way way) { return lines_.step(a, way) == b; });
}

std::array<double, BorderLines::kDirections> BorderLines::Surroundings::weigh() {
  const auto& [along_x, along_y] = sides();
  const double xx = glm::dot(along_x, along_x), xy = glm::dot(along_x, along_y),
               yy = glm::dot(along_y, along_y);
  const double area = std::sqrt(std::max(xx * yy - xy * xy, 0.0));
  std::array<double, kDirections> weights{};
  if (area <= 0) return weights;
  const double side = std::sqrt(xx);
  std::array<double, kDirections> angles{}, lengths{};
  for (std::size_t k = 0; k < kDirections; ++k) {
    const glm::dvec2 line(kDirection[k][0] * side + kDirection[k][1] * xy / side,
                          kDirection[k][1] * area / side);
    angles[k] = std::atan2(line.y, line.x);
    lengths[k] = glm::length(line);
  }
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double before = k > 0 ? angles[k - 1] : angles[kDirections - 1] - std::numbers::pi;
    const double after = k + 1 < kDirections ? angles[k + 1] : angles[0] + std::numbers::pi;
    weights[k] = (after - before) / 4 * area / lengths[k];
  }
  return weights;
}

const std::pair<glm::dvec3, glm::dvec3>& BorderLines::Surroundings::sides() {
  if (sides_) return *sides_;
  const glm::dvec3 here = lines_.place(texel_);
  const auto side = [&](Way forward, Way back) {
    const std::uint32_t next = lines_.step(texel_, forward), before = lines_.step(texel_, back);
    const glm::dvec3 from = before != kNoNeighbour ? lines_.place(before) : here,
                     to = next != kNoNeighbour ? lines_.place(next) : here;
    return (to - from) / (before != kNoNeighbour && next != kNoNeighbour ? 2.0 : 1.0);
  };
  sides_.emplace(side(Way::right, Way::left), side(Way::upper, Way::lower));
  if (glm::length(glm::cross(sides_->first, sides_->second)) > 0) return *sides_;
  // In an island that is one texel wide, the texel is treated as a square.
  const double edge = std::sqrt(lines_.map_.area[texel_]);
  sides_ = {glm::dvec3(edge, 0, 0), glm::dvec3(0, edge, 0)};
  return *sides_;
}

}  // namespace strata::query
