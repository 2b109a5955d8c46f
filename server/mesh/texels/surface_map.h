#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.h"
#include "domain/layers/tile.h"
#include "mesh/surface/block_tree.h"

namespace strata {
class Progress;
}

namespace strata::mesh {

struct Geometry;

constexpr std::uint32_t kNoSlot = 0xffffffffu;
constexpr std::uint64_t kNoPosition = ~std::uint64_t{0};

// The position on the surface of every texel of a model's atlas at one resolution. Baked on the
// CPU, so that it is the same on every GPU. Only occupied 8 × 8 blocks are stored ("slots").
//
// - *Surface texels* are those whose center a triangle covers (OpenGL's rule on vertices snapped to
//   1/256 texel), and the nearest texel of a triangle that covers no center (conservative fill)
//   where no other triangle owns it.
// - *Gutter texels* are the ring of 2 texels around an island. They have the position of the
//   nearest surface texel of their own island, so an edit treats them exactly as their owner.
// - Area: each triangle is clipped against the texel grid, and each piece is credited to the
//   surface texel that owns the texel it lies in (its own chart's); the sum is the mesh area.
struct SurfaceMap {
  int resolution = 0;
  int blocks_per_side = 0;  // resolution / 8
  // blocks_per_side², row-major; kNoSlot for an empty block
  std::vector<std::uint32_t> slot_of_block;
  std::vector<std::uint32_t> block_of_slot;  // y * blocks_per_side + x
  // 64 a slot, row-major in the block: x 21 bits, y 21 << 21, z 22 << 42
  // of the slot's box; kNoPosition: neither surface nor gutter
  std::vector<std::uint64_t> packed_position;
  // A position is min + (x, y, z) * step, exactly: steps are powers of two. With a separate box for
  // each block positions are about as fine as floats of model space, and a gutter texel has exactly
  // the position of its owner, even in another block.
  struct PackedBox {
    glm::vec3 min{0}, step{0};
  };
  std::vector<PackedBox> packed_box;  // a slot
  // a slot: bit (y*8+x) set where the texel is surface (not gutter)
  std::vector<std::uint64_t> surface_mask;
  std::vector<float> area;  // 64 a slot, unit²; 0 on gutter

  std::vector<BoundingSphere> bounds_of_slot;
  std::vector<BoundingSphere> bounds_of_tile;  // (resolution/128)², row-major
  BlockTree tree;

  std::uint64_t surface_texels = 0;
  std::uint64_t gutter_texels = 0;
  // centers covered by more than one triangle beyond shared edges
  std::uint64_t overlap_texels = 0;
  double area_total = 0;

  glm::vec3 position(std::uint32_t slot, int texel) const;
  TileMask owned_in_tile(TileAddress tile) const;  // surface and gutter texels
  TileMask surface_in_tile(TileAddress tile) const;
  float area_of(TileAddress tile, int texel) const;  // unit²
  std::size_t bytes() const;
};

// `malformed` for a resolution that is no multiple of 128 in 128…16384.
Result<void> check_map_resolution(int resolution);

// The result does not depend on the number of threads; memory ≤ 40 bytes per covered texel while it
// runs. Refused when cancelled, and for a resolution that is no multiple of 128 in 128…16384.
Result<SurfaceMap> bake_surface_map(const Geometry& geometry, int resolution, Progress& progress,
                                    int threads = 2);

}  // namespace strata::mesh
