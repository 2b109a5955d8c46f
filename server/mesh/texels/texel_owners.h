#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "core/progress.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/parallel.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The triangle of every surface texel of an atlas at one resolution, and the position in it, for
// painting values that are computed from the mesh. The same texels in the same slots as the
// SurfaceMap of that resolution, by the same code. Made when needed and discarded: 8 bytes a texel
// that painting with a brush does not need.
struct TexelOwners {
  int resolution = 0;
  int blocks_per_side = 0;
  std::vector<std::uint32_t> block_of_slot;  // y * blocks_per_side + x
  std::vector<std::uint64_t> surface_mask;   // a slot: bit (y*8+x)
  // 64 a slot; undefined if the texel is not a surface texel
  std::vector<std::uint32_t> triangle;
  // 64 a slot: of the second corner and << 16 of the third, in 1/65535
  std::vector<std::uint32_t> weights;
  struct Gutter {
    // a gutter texel and the surface texel it follows; indices into the 64 a slot
    std::uint32_t texel, owner;
  };
  std::vector<Gutter> gutter;

  glm::vec3 weights_of(std::size_t texel) const {
    const float b = static_cast<float>(weights[texel] & 0xffff) / 65535.0f,
                c = static_cast<float>(weights[texel] >> 16) / 65535.0f;
    return {std::max(0.0f, 1 - b - c), b, c};
  }
};

// Refused when cancelled, and for a resolution that is no multiple of 128 in 128…16384.
Result<TexelOwners> bake_texel_owners(const Geometry& geometry, int resolution, Progress& progress,
                                      int threads = background_threads());

// Calls `visit(texel)` for every surface texel (its index into the 64 a slot), on several threads
// at once, and reports `message`. One thread visits the texels of one range of kTexelsAtOnce (from
// a multiple of it) in order. Refused when cancelled.
constexpr std::size_t kTexelsAtOnce = 256 * 64;
using TexelVisit = std::function<void(std::size_t texel)>;
Result<void> for_each_texel(const TexelOwners& owners, const TexelVisit& visit, const char* message,
                            Progress& progress, int threads = background_threads());

// Paints the surface: each texel gets the bits of the layer's value that `bits_at` returns for it,
// or nothing; gutter texels follow their owners. Calls `bits_at` as `visit` above.
using TexelBits = std::function<std::optional<std::uint32_t>(std::size_t texel)>;
Result<TileMap> paint_texels(const TexelOwners& owners, ValueType type, const TexelBits& bits_at,
                             Progress& progress, int threads = background_threads());

}  // namespace strata::mesh
