#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/distance/seam_triangles.h"
#include "mesh/distance/surface_distance.h"
#include "mesh/distance/wave_front.h"

namespace strata::mesh {

// Moves the front through the texels of one block of 8 × 8 texels. The result depends only on the
// distances that are known before. An object keeps its memory for the next block. Use each object
// on one thread.
class BlockFront {
 public:
  // Distances beyond `limit` (model units) are not stored.
  BlockFront(const SurfaceMap& map, const TexelGraph& graph, const SurfaceDistances& known,
             float limit)
      : map_(map), graph_(graph), known_(known), limit_(limit) {}

  // Computes the distances of a slot from its sources and from the known distances around it.
  // `seam` are its triangles across seams. Returns the texels that are now nearer than before.
  std::uint64_t move(std::uint32_t slot, const std::vector<SeamTriangle>& seam,
                     SurfaceDistances::Block& block);

 private:
  // A window of cells: the texels of the block, and a ring of texels around them.
  static constexpr int kWide = 10, kCells = kWide * kWide;
  static constexpr int cell_of(int texel) { return (texel / 8 + 1) * kWide + texel % 8 + 1; }
  // The neighbors of a cell, counterclockwise from the right.
  static constexpr std::array<int, 8> kRing{1, 11, 10, 9, -1, -11, -10, -9};

  void load(std::uint32_t slot);
  void load_texel(int cell, std::uint32_t slot, std::uint32_t texel);
  void find_neighbours();
  void measure_sides();
  void move_across_seams(std::uint32_t slot, const std::vector<SeamTriangle>& seam);
  void move_from(int cell);
  void update(int cell, int way);
  void cross(int cell, const FrontTriangle& sides, const TexelDistance& a, const TexelDistance& b);
  void lower(int cell, double distance, std::uint32_t source, double side);
  float side(int cell, int way) const;
  float across(int cell, int first, int second) const;

  const SurfaceMap& map_;
  const TexelGraph& graph_;
  const SurfaceDistances& known_;
  const float limit_;

  std::array<float, kCells> distance_{};
  std::array<std::uint32_t, kCells> source_{};
  std::array<glm::vec3, kCells> position_{};
  std::array<bool, kCells> present_{}, to_right_{}, to_upper_{};
  // Lengths from a cell to the cells of kRing[0…3].
  std::array<std::array<float, kCells>, 4> sides_{};
  // The connected neighbors of each cell of the block, one bit each. Cells outside have none. It
  // begins kMargin before the first cell, because neighbors of the ring may lie outside the window.
  static constexpr int kMargin = 11;
  std::array<std::uint8_t, kCells + 2 * kMargin> ring_{};
  std::uint64_t nearer_ = 0;
  using Entry = std::pair<float, int>;  // distance, cell
  std::vector<Entry> queue_;
};

}  // namespace strata::mesh
