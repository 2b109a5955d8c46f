#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesh/texels/packed_position.h"
#include "mesh/texels/texel_graph.h"
#include "query/regions/neighborhood_limits.h"
#include "query/regions/texel_balls.h"

namespace strata::query {

// Returns the side of a texel with the mean area, in model units; 0 without texels.
double mean_texel_size(const mesh::SurfaceMap& map);

// Returns the surface texel at a position in the atlas, or kNoNeighbour.
inline std::uint32_t texel_in_atlas(const mesh::SurfaceMap& map, int x, int y) {
  const std::uint32_t slot = map.slot_of_block[static_cast<std::size_t>(y / kBlockSize) *
                                                   static_cast<std::size_t>(map.blocks_per_side) +
                                               static_cast<std::size_t>(x / kBlockSize)];
  if (slot == mesh::kNoSlot) return mesh::kNoNeighbour;
  const int i = y % kBlockSize * kBlockSize + x % kBlockSize;
  return (map.surface_mask[slot] >> i & 1u) != 0 ? slot * 64 + static_cast<std::uint32_t>(i)
                                                 : mesh::kNoNeighbour;
}

// The texels within a radius of a texel, along the surface. Use each object on one thread.
//
// Within a chart of the atlas, they are an ellipse of texels, from the size and shear of the texels
// in the middle. On scans, the sizes of texels differ from triangle to triangle. So if texels at
// the rim are too far away, the rows of the ellipse end at the last texel within the radius,
// measured straight through space. Where a seam, an open edge or a gap is near, connected texels
// are followed instead. A flat surface has the same neighborhood both ways, so a seam changes
// nothing. At places where texels are much smaller than the mean, it ends after four times the
// usual number of texels.
//
// Near seams, all texels are within the radius. Within a chart, the rim of all but the smallest
// ellipses is measured in eight directions only, and rows at their ends only. On scans with a
// radius of 3 to 20 texels, less than 0.5 % of the neighborhoods have a texel farther away than 1.1
// times the radius and the size of a texel, and none has one beyond 1.3 times the radius. On a
// curved or rough surface, texels within the radius can be missing where texels are smaller than in
// the middle.
class TexelDiscs {
 public:
  // `radius` is in model units, at most kMaxDiscTexels texels of the mean size.
  TexelDiscs(const mesh::SurfaceMap& map, const mesh::TexelGraph& graph, double radius);

  // Calls chord(y, x0, x1) for each row of the ellipse, with columns of the atlas. Returns false if
  // the texels are not all connected in the atlas, or if a call returns false because the texels of
  // the row are not connected along the row.
  template <class Visit>
  bool for_each_chord(std::uint32_t texel, Visit&& visit) const {
    const auto ellipse = ellipse_around(texel);
    if (!ellipse) return false;
    Chord through_center = ellipse->chord_at(0);
    if (through_center.last - through_center.first > 2 * kMaxRows ||
        !cut_to_radius(through_center, ellipse->y, *ellipse) ||
        !visit(ellipse->y, through_center.first, through_center.last))
      return false;
    for (const int way : {1, -1}) {
      Chord before = through_center;
      int row_before = 0;
      for (int row = 1; row <= ellipse->rows; ++row) {
        Chord chord = ellipse->chord_at(way * row);
        if (chord.first > chord.last) continue;  // passes between two texels
        const int y = ellipse->y + way * row;
        if (!cut_to_radius(chord, y, *ellipse)) return false;
        if (chord.first > chord.last) break;  // all of the row is too far away
        if (row_before != row - 1 || !are_connected(before, chord, y - way, y) ||
            !visit(y, chord.first, chord.last))
          return false;
        before = chord;
        row_before = row;
      }
    }
    return true;
  }

  // For places where for_each_chord returns false. Returns the connected texels in a ball. At a
  // fold or a thin wall, where a ball reaches too much surface, returns those on paths within the
  // ball (TexelBalls::on_paths). They are valid until the next call.
  std::span<const BlockTexels> blocks_around(std::uint32_t texel);

  // The connected texels in balls, also at folds.
  TexelBalls& balls() { return balls_; }

 private:
  static constexpr int kMaxRows = 4 * static_cast<int>(kMaxDiscTexels);
  struct Chord {
    int first, last;
  };
  struct Ellipse {
    double radius, shear, height_squared, width_squared;  // of a texel, across and along its rows
    int x, y, rows;
    glm::vec3 center;
    // Because some texels at the rim are too far away.
    bool measures_rows = false;
    Chord chord_at(int dy) const {
      const double half = std::sqrt(
          std::max(0.0, (radius * radius - double(dy) * dy * height_squared) / width_squared));
      const double middle = x - shear * dy;
      // Rounded up and down, faster than with std::ceil and std::floor.
      const double left = middle - half, right = middle + half;
      const int first = static_cast<int>(left), last = static_cast<int>(right);
      return {first + (left > first ? 1 : 0), last - (right < last ? 1 : 0)};
    }
  };

  glm::dvec3 place(std::uint32_t texel) const {
    return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
  }
  double area_of(const BlockTexels& block) const;
  std::uint32_t walk(std::uint32_t texel, mesh::Way way, int steps) const;
  std::optional<Ellipse> ellipse_around(std::uint32_t texel) const;
  bool is_too_large(const Ellipse& ellipse) const;
  // Takes away the texels at the ends of a row that are farther from the center than the radius.
  // Returns false if the row leaves the surface there.
  bool cut_to_radius(Chord& chord, int y, const Ellipse& ellipse) const {
    if (!ellipse.measures_rows) return true;
    if (y < 0 || chord.first < 0 || y >= map_.resolution || chord.last >= map_.resolution)
      return false;
    for (; chord.first <= chord.last; ++chord.first) {
      const std::uint32_t end = texel_in_atlas(map_, chord.first, y);
      if (end == mesh::kNoNeighbour) return false;
      if (is_within(end, ellipse.center, squared_radius_)) break;
    }
    for (; chord.first < chord.last; --chord.last) {
      const std::uint32_t end = texel_in_atlas(map_, chord.last, y);
      if (end == mesh::kNoNeighbour) return false;
      if (is_within(end, ellipse.center, squared_radius_)) break;
    }
    return true;
  }
  bool is_within(std::uint32_t texel, const glm::vec3& center, float squared_radius) const {
    const glm::vec3 way =
        mesh::unpack_position(map_.packed_position[texel], map_.packed_box[texel / 64]) - center;
    return glm::dot(way, way) <= squared_radius;
  }
  bool are_connected(const Chord& a, const Chord& b, int y_of_a, int y_of_b) const;

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const double radius_, texels_in_radius_, disc_area_;
  const float squared_radius_;
  TexelBalls balls_;
};

}  // namespace strata::query
