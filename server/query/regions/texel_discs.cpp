#include "query/regions/texel_discs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

namespace strata::query {
namespace {

using mesh::kNoNeighbour;
using mesh::Way;

// Texels whose distance equals the radius are inside, in spite of rounding errors.
constexpr double kRim = 1 + 1e-4;
// Texels at the rim may be farther away than the radius by this factor before all rows are
// measured.
constexpr float kFits = 1.03f;
constexpr int kFewRows = 4;

}  // namespace

double mean_texel_size(const mesh::SurfaceMap& map) {
  return map.surface_texels == 0
             ? 0
             : std::sqrt(map.area_total / static_cast<double>(map.surface_texels));
}

TexelDiscs::TexelDiscs(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, double radius)
    : map_(map),
      graph_(graph),
      radius_(radius * kRim),
      texels_in_radius_(radius / mean_texel_size(map)),
      // of the texels in a flat disc, with some more at its rim
      disc_area_(std::numbers::pi * std::pow(radius + mean_texel_size(map) / 2, 2)),
      squared_radius_(static_cast<float>(radius_ * radius_)),
      // At places where texels are much smaller than the mean
      balls_(map, graph, radius_,
             256 + static_cast<std::size_t>(4 * std::numbers::pi * texels_in_radius_ *
                                            texels_in_radius_)) {}

std::span<const BlockTexels> TexelDiscs::blocks_around(std::uint32_t texel) {
  const auto found = balls_.around(texel);
  double area = 0;
  for (const BlockTexels& block : found) area += area_of(block);
  // A ball with more surface than a disc reaches through a fold.
  constexpr double kFolded = 1.1;
  return area <= kFolded * disc_area_ ? found : balls_.on_paths(texel);
}

double TexelDiscs::area_of(const BlockTexels& block) const {
  if (block.bits == map_.surface_mask[block.slot]) return map_.sums_of_slot[block.slot].area;
  double area = 0;
  for (std::uint64_t left = block.bits; left != 0; left &= left - 1)
    area += double{map_.area[block.slot * 64 + static_cast<std::uint32_t>(std::countr_zero(left))]};
  return area;
}

std::uint32_t TexelDiscs::walk(std::uint32_t texel, Way way, int steps) const {
  for (int i = 0; i < steps && texel != kNoNeighbour; ++i)
    texel = mesh::neighbour(map_, graph_, texel, way);
  return texel;
}

// Returns nothing near a seam or an edge. Measures the sides of a texel over a few texels, so that
// the noise of a scan does not make texels larger.
std::optional<TexelDiscs::Ellipse> TexelDiscs::ellipse_around(std::uint32_t texel) const {
  const int steps = std::clamp(static_cast<int>(texels_in_radius_ / 2), 1, 4);
  const std::array ends{walk(texel, Way::left, steps), walk(texel, Way::right, steps),
                        walk(texel, Way::lower, steps), walk(texel, Way::upper, steps)};
  for (const std::uint32_t end : ends)
    if (end == kNoNeighbour) return std::nullopt;
  const glm::dvec3 x_side = (place(ends[1]) - place(ends[0])) / (2.0 * steps),
                   y_side = (place(ends[3]) - place(ends[2])) / (2.0 * steps);
  const double xx = glm::dot(x_side, x_side), xy = glm::dot(x_side, y_side);
  if (xx <= 0) return std::nullopt;
  const double shear = xy / xx, height_squared = glm::dot(y_side, y_side) - xy * shear;
  if (!(height_squared > 0)) return std::nullopt;
  const double rows = std::floor(radius_ / std::sqrt(height_squared));
  if (rows > kMaxRows) return std::nullopt;
  const auto block = static_cast<int>(map_.block_of_slot[texel / 64]),
             i = static_cast<int>(texel % 64);
  Ellipse ellipse{radius_,
                  shear,
                  height_squared,
                  xx,
                  block % map_.blocks_per_side * kBlockSize + i % kBlockSize,
                  block / map_.blocks_per_side * kBlockSize + i / kBlockSize,
                  static_cast<int>(rows),
                  map_.position(texel / 64, static_cast<int>(texel % 64))};
  // A measurement of all rows of a small ellipse takes no longer.
  ellipse.measures_rows = ellipse.rows < kFewRows || is_too_large(ellipse);
  return ellipse;
}

// Reads few texels, because reading positions takes a large part of the time of a small disc.
bool TexelDiscs::is_too_large(const Ellipse& ellipse) const {
  constexpr double kDiagonal = std::numbers::sqrt2 / 2;
  constexpr std::array<std::array<double, 2>, 8> kWays{{{1, 0},
                                                        {-1, 0},
                                                        {0, 1},
                                                        {0, -1},
                                                        {kDiagonal, kDiagonal},
                                                        {-kDiagonal, -kDiagonal},
                                                        {kDiagonal, -kDiagonal},
                                                        {-kDiagonal, kDiagonal}}};
  const double columns = radius_ / std::sqrt(ellipse.width_squared),
               rows = radius_ / std::sqrt(ellipse.height_squared);
  return std::ranges::any_of(kWays, [&](const auto& way) {
    const int dy = static_cast<int>(way[1] * rows),
              dx = static_cast<int>(way[0] * columns - ellipse.shear * dy);
    const int x = ellipse.x + dx, y = ellipse.y + dy;
    if (x < 0 || y < 0 || x >= map_.resolution || y >= map_.resolution) return true;
    const std::uint32_t at_rim = texel_in_atlas(map_, x, y);
    return at_rim == kNoNeighbour ||
           !is_within(at_rim, ellipse.center, kFits * kFits * squared_radius_);
  });
}

// Returns whether two adjacent rows are connected at a column of both chords.
bool TexelDiscs::are_connected(const Chord& a, const Chord& b, int y_of_a, int y_of_b) const {
  const int first = std::max(a.first, b.first), last = std::min(a.last, b.last);
  const int lower_row = std::min(y_of_a, y_of_b);
  if (first < 0 || first > last || last >= map_.resolution || lower_row < 0 ||
      lower_row >= map_.resolution)
    return false;
  const std::uint32_t texel = texel_in_atlas(map_, (first + last) / 2, lower_row);
  return texel != kNoNeighbour && (graph_.to_upper[texel / 64] >> texel % 64 & 1u) != 0;
}

}  // namespace strata::query
