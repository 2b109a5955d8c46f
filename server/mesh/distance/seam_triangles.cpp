#include "mesh/distance/seam_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

namespace strata::mesh {
namespace {

constexpr std::size_t kDirections = 16;
// Each texel forms triangles with this many of the next texels around the center. One is too few: a
// front may need two texels with the same source.
constexpr std::size_t kNext = 3;
constexpr double kWidestAngle = 0.8 * std::numbers::pi;

bool bit_of(const std::vector<std::uint64_t>& bits, std::uint32_t texel) {
  return (bits[texel / 64] >> texel % 64 & 1u) != 0;
}

class Fan {
 public:
  Fan(const SurfaceMap& map, const TexelGraph& graph) : map_(map), graph_(graph) {}

  void add_triangles(std::uint32_t texel, std::vector<SeamTriangle>& triangles) {
    if (!bit_of(graph_.has_links, texel) && has_all_neighbours(texel)) return;
    if (!reach(texel)) return;
    for (const std::uint32_t other : beside_)
      triangles.push_back({texel, other, kNoNeighbour, length(texel, other), 0, 0});
    sort_by_direction(texel);
    const std::size_t count = around_.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t next = i + 1; next <= i + kNext && next < i + count; ++next) {
        const Place &a = around_[i], &b = around_[next % count];
        const double angle = b.angle - a.angle + (next >= count ? 2 * std::numbers::pi : 0);
        const float apart = length(a.texel, b.texel);
        if (angle <= kWidestAngle && apart > 0)
          triangles.push_back({texel, a.texel, b.texel, a.distance, b.distance, apart});
      }
  }

 private:
  struct Place {
    std::uint32_t texel = kNoNeighbour;
    float distance = 0;
    double angle = 0;
  };

  glm::dvec3 position(std::uint32_t texel) const {
    return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
  }
  float length(std::uint32_t a, std::uint32_t b) const {
    return static_cast<float>(glm::distance(position(a), position(b)));
  }

  bool has_all_neighbours(std::uint32_t texel) const {
    const auto both = [&](Way first, Way second) {
      const std::uint32_t next = neighbour(map_, graph_, texel, first);
      return next != kNoNeighbour && neighbour(map_, graph_, next, second) != kNoNeighbour;
    };
    return both(Way::right, Way::upper) && both(Way::upper, Way::left) &&
           both(Way::left, Way::lower) && both(Way::lower, Way::right);
  }

  // Finds the texels at most two steps away. Returns false if no step follows a link.
  bool reach(std::uint32_t texel) {
    reached_.assign(1, texel);
    beside_.clear();
    bool over = false;
    for (std::size_t i = 0, last = 1, step = 0; step < 2; ++step, last = reached_.size())
      for (; i < last; ++i) {
        const std::uint32_t from = reached_[i];
        over = over || bit_of(graph_.has_links, from);
        for_each_neighbour(map_, graph_, from, [&](std::uint32_t next) {
          if (std::ranges::find(reached_, next) == reached_.end()) reached_.push_back(next);
        });
        if (step == 0) beside_.assign(reached_.begin() + 1, reached_.end());
      }
    return over;
  }

  // The surface normal near the texel: the direction in which the texels around it extend least.
  // It is the largest column of the adjugate of their covariance matrix.
  std::optional<glm::dvec3> normal(const glm::dvec3& here) const {
    glm::dmat3 sum(0);
    for (const std::uint32_t other : reached_) {
      const glm::dvec3 way = position(other) - here;
      if (const double length = glm::length(way); length > 0)
        sum += glm::outerProduct(way, way) / (length * length);
    }
    const std::array<glm::dvec3, 3> columns{glm::cross(sum[1], sum[2]), glm::cross(sum[2], sum[0]),
                                            glm::cross(sum[0], sum[1])};
    std::size_t best = 0;
    for (int k = 1; k < 3; ++k)
      if (columns[static_cast<std::size_t>(k)][k] > columns[best][static_cast<int>(best)])
        best = static_cast<std::size_t>(k);
    const double length = glm::length(columns[best]);
    if (!(length > 1e-9)) return std::nullopt;  // the texels lie on one line
    return columns[best] / length;
  }

  // Sets around_ to the nearest texel in each of 16 directions, counterclockwise.
  void sort_by_direction(std::uint32_t texel) {
    around_.clear();
    const glm::dvec3 here = position(texel);
    const auto up = normal(here);
    if (!up) return;
    const glm::dvec3 across = std::abs(up->x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(across, *up)), y = glm::cross(*up, x);
    std::array<Place, kDirections> nearest{};
    for (std::size_t i = 1; i < reached_.size(); ++i) {
      const glm::dvec3 way = position(reached_[i]) - here;
      const double angle = std::atan2(glm::dot(way, y), glm::dot(way, x));
      const auto distance = static_cast<float>(glm::length(way));
      if (distance <= 0) continue;
      const auto direction =
          static_cast<std::size_t>((angle / (2 * std::numbers::pi) + 0.5) * double(kDirections)) %
          kDirections;
      Place& place = nearest[direction];
      if (place.texel == kNoNeighbour || distance < place.distance)
        place = {reached_[i], distance, angle};
    }
    for (const Place& place : nearest)
      if (place.texel != kNoNeighbour) around_.push_back(place);
    std::ranges::sort(around_, {}, &Place::angle);
  }

  const SurfaceMap& map_;
  const TexelGraph& graph_;
  std::vector<std::uint32_t> reached_, beside_;
  std::vector<Place> around_;
};

}  // namespace

std::vector<SeamTriangle> seam_triangles(const SurfaceMap& map, const TexelGraph& graph,
                                         std::uint32_t slot) {
  std::vector<SeamTriangle> triangles;
  Fan fan(map, graph);
  for (std::uint64_t left = map.surface_mask[slot]; left != 0; left &= left - 1)
    fan.add_triangles(slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left)), triangles);
  triangles.shrink_to_fit();
  return triangles;
}

}  // namespace strata::mesh
