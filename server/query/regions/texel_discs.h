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

#include "mesh/texels/texel_graph.h"
#include "query/regions/texel_balls.h"

namespace strata::query {

// The largest radius of neighborhoods, in texels of the mean size. Bounds the time per texel.
constexpr double kMaxDiscTexels = 40;

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
// in the middle. Where a seam, an open edge or a gap is near, connected texels are followed
// instead. A flat surface has the same neighborhood both ways, so a seam changes nothing. At places
// where texels are much smaller than the mean, it ends after four times the usual number of texels.
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
    const Chord through_center = ellipse->chord_at(0);
    if (through_center.last - through_center.first > 2 * kMaxRows ||
        !visit(ellipse->y, through_center.first, through_center.last))
      return false;
    for (const int way : {1, -1}) {
      Chord before = through_center;
      int row_before = 0;
      for (int row = 1; row <= ellipse->rows; ++row) {
        const Chord chord = ellipse->chord_at(way * row);
        if (chord.first > chord.last) continue;  // passes between two texels
        const int y = ellipse->y + way * row;
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
    Chord chord_at(int dy) const {
      const double half = std::sqrt(
          std::max(0.0, (radius * radius - double(dy) * dy * height_squared) / width_squared));
      const double middle = x - shear * dy;
      return {static_cast<int>(std::ceil(middle - half)),
              static_cast<int>(std::floor(middle + half))};
    }
  };

  glm::dvec3 place(std::uint32_t texel) const {
    return glm::dvec3(map_.position(texel / 64, static_cast<int>(texel % 64)));
  }
  double area_of(const BlockTexels& block) const;
  std::uint32_t walk(std::uint32_t texel, mesh::Way way, int steps) const;
  std::optional<Ellipse> ellipse_around(std::uint32_t texel) const;
  bool are_connected(const Chord& a, const Chord& b, int y_of_a, int y_of_b) const;

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const double radius_, texels_in_radius_, disc_area_;
  TexelBalls balls_;
};

}  // namespace strata::query
