#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "mesh/texels/texel_graph.h"

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

// A set of texels with a length for each: a hash table with a stamp per set, so that it need not be
// cleared.
class TexelLengths {
 public:
  // The set holds at most about four times the expected number of texels.
  explicit TexelLengths(std::size_t expected)
      : entries_(std::bit_ceil(std::max<std::size_t>(8 * expected, 1024))) {}
  void clear() {
    ++stamp_;
    count_ = 0;
  }
  bool full() const { return count_ >= entries_.size() / 2; }
  // Returns the length of the texel, and whether the texel is new.
  std::pair<float&, bool> add(std::uint32_t texel) {
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = texel * 0x9e3779b1u & mask;
    while (entries_[at].stamp == stamp_) {
      if (entries_[at].texel == texel) return {entries_[at].length, false};
      at = (at + 1) & mask;
    }
    entries_[at] = {texel, stamp_, 0};
    ++count_;
    return {entries_[at].length, true};
  }

 private:
  struct Entry {
    std::uint32_t texel = 0;
    std::uint32_t stamp = 0;
    float length = 0;
  };
  std::vector<Entry> entries_;
  std::uint32_t stamp_ = 1;
  std::size_t count_ = 0;
};

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

  // Calls visit(texel) for the connected texels in a ball. Their distances are straight through
  // space.
  template <class Visit>
  void for_each_in_ball(std::uint32_t start, Visit&& visit) {
    begin(start);
    const glm::dvec3 center = place(start);
    for (std::size_t next = 0; next < open_.size(); ++next) {
      const std::uint32_t texel = open_[next].first;
      visit(texel);
      mesh::for_each_neighbour(map_, graph_, texel, [&](std::uint32_t other) {
        if (lengths_.full() || !lengths_.add(other).second) return;
        if (glm::distance(place(other), center) <= radius_) open_.emplace_back(other, 0.0f);
      });
    }
  }

  // Like for_each_in_ball, but does not reach the other side of a fold or of a thin wall before the
  // path around it is short enough. Paths have steps like those of a king in chess, so at a fold
  // the radius is up to 8 % too large. Takes about five times as long.
  template <class Visit>
  void for_each_on_paths(std::uint32_t start, Visit&& visit) {
    begin(start);
    visit(start);
    const glm::dvec3 center = place(start);
    for (std::size_t next = 0; next < open_.size(); ++next) {
      const auto [texel, length] = open_[next];
      if (lengths_.add(texel).first < length) continue;
      const glm::dvec3 from = place(texel);
      const auto step_to = [&, length = length](std::uint32_t other) {
        const glm::dvec3 to = place(other);
        const auto path = length + static_cast<float>(glm::distance(from, to));
        if (path > kLongestPath * radius_ || glm::distance(to, center) > radius_ || lengths_.full())
          return;
        const auto [known, is_new] = lengths_.add(other);
        if (!is_new && path >= known * kLeastGain) return;
        known = path;
        open_.emplace_back(other, path);
        if (is_new) visit(other);
      };
      // Two steps reach the diagonal neighbors, also across a seam.
      mesh::for_each_neighbour(map_, graph_, texel, [&](std::uint32_t beside) {
        step_to(beside);
        mesh::for_each_neighbour(map_, graph_, beside, step_to);
      });
    }
  }

 private:
  static constexpr int kMaxRows = 4 * static_cast<int>(kMaxDiscTexels);
  // The greatest ratio of a path of steps to 8 neighbors and a straight line.
  static constexpr double kLongestPath = 1.0824;
  static constexpr float kLeastGain = 0.999f;
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
  void begin(std::uint32_t start) {
    lengths_.clear();
    lengths_.add(start);
    open_.assign(1, {start, 0.0f});
  }
  std::uint32_t walk(std::uint32_t texel, mesh::Way way, int steps) const;
  std::optional<Ellipse> ellipse_around(std::uint32_t texel) const;
  bool are_connected(const Chord& a, const Chord& b, int y_of_a, int y_of_b) const;

  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const double radius_, texels_in_radius_;
  TexelLengths lengths_;
  std::vector<std::pair<std::uint32_t, float>> open_;
};

}  // namespace strata::query
