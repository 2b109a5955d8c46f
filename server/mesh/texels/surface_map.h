#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "core/error.h"
#include "domain/layers/tile.h"
#include "domain/scene/model_part.h"
#include "mesh/surface/block_tree.h"

namespace strata {
class Progress;
}

namespace strata::mesh {

struct Geometry;

constexpr std::uint32_t kNoSlot = 0xffffffffu;
constexpr std::uint64_t kNoPosition = ~std::uint64_t{0};

// The position on the surface of every texel of a model's atlas at one resolution. It is baked on
// the CPU, so it does not depend on the GPU. Only occupied 8 × 8 blocks are stored ("slots").
//
// - *Surface texels* have a center that a triangle covers (OpenGL's rule for vertices snapped to
//   1/256 texel). A triangle that covers no center gets the nearest texel as a surface texel if no
//   other triangle owns it (conservative fill).
// - *Gutter texels* are the ring of 2 texels around an island. They have the position of the
//   nearest surface texel of their own island, so an edit treats them exactly like their owner.
// - Area: each triangle is clipped against the texel grid. Each piece is credited to the surface
//   texel of the same chart that owns the texel of the piece. The sum is the mesh area.
struct SurfaceMap {
  int resolution = 0;
  int blocks_per_side = 0;  // resolution / 8
  // blocks_per_side², row-major; kNoSlot for an empty block
  std::vector<std::uint32_t> slot_of_block;
  std::vector<std::uint32_t> block_of_slot;  // y * blocks_per_side + x
  // 64 per slot, row-major in the block: x 21 bits, y 21 << 21, z 22 << 42, in the slot's box.
  // kNoPosition: neither surface nor gutter.
  std::vector<std::uint64_t> packed_position;
  // A position is exactly min + (x, y, z) * step, because steps are powers of two. With a separate
  // box for each block, positions are about as precise as floats of model space. A gutter texel has
  // exactly the position of its owner, even in another block.
  struct PackedBox {
    glm::vec3 min{0}, step{0};
  };
  std::vector<PackedBox> packed_box;  // one per slot
  // one per slot; bit (y*8+x) is set for a surface texel (not gutter)
  std::vector<std::uint64_t> surface_mask;
  std::vector<float> area;  // 64 per slot, in unit²; 0 for gutter texels

  // The part of each surface and gutter texel, 64 per slot. Empty: the model is one part.
  std::vector<std::uint8_t> part;

  // Sums of surface texels of one slot. A sum of 64 such values in double precision loses almost
  // nothing.
  struct SlotSums {
    std::uint64_t texels = 0;
    double area = 0;                  // in unit²
    glm::dvec3 weighted_position{0};  // sum of area × position
    glm::vec3 lowest{std::numeric_limits<float>::infinity()};
    glm::vec3 highest{-std::numeric_limits<float>::infinity()};
    bool operator==(const SlotSums&) const = default;
  };
  // The sums of all surface texels of each slot. After a stroke, most changed blocks have one
  // value. Their sums need not be computed again.
  std::vector<SlotSums> sums_of_slot;

  std::vector<BoundingSphere> bounds_of_slot;
  std::vector<BoundingSphere> bounds_of_tile;  // (resolution/128)², row-major
  BlockTree tree;

  std::uint64_t surface_texels = 0;
  std::uint64_t gutter_texels = 0;
  // texels with a center covered by more than one triangle, except on shared edges
  std::uint64_t overlap_texels = 0;
  double area_total = 0;

  glm::vec3 position(std::uint32_t slot, int texel) const;
  TileMask owned_in_tile(TileAddress tile) const;  // surface and gutter texels
  TileMask surface_in_tile(TileAddress tile) const;
  float area_of(TileAddress tile, int texel) const;  // in unit²
  // The texels of a slot that belong to one of these parts, as bits y * 8 + x.
  std::uint64_t texels_of_parts(std::uint32_t slot, const PartSet& parts) const;
  void add_texel(SlotSums& sums, std::uint32_t slot, int texel) const;
  SlotSums sum_slot(std::uint32_t slot) const;  // the value for `sums_of_slot`
  std::size_t bytes() const;
};

// Fails with `malformed` if the resolution is not a multiple of 128 in the range 128…16384.
Result<void> check_map_resolution(int resolution);

// The result does not depend on the number of threads. While it runs, the function needs at most 40
// bytes of memory per covered texel. Fails when cancelled, or if the resolution is not a multiple
// of 128 in the range 128…16384.
Result<SurfaceMap> bake_surface_map(const Geometry& geometry, int resolution, Progress& progress,
                                    int threads = 2);

}  // namespace strata::mesh
