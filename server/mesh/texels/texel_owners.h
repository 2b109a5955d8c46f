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

// The triangle of every surface texel of an atlas at one resolution, and the texel's position in
// the triangle. It is used for painting values that are computed from the mesh. The same code
// determines the texels and slots of the SurfaceMap at that resolution, so they are identical. This
// data is made when needed and then discarded, because it takes 8 bytes per texel and brushes do
// not need it.
struct TexelOwners {
  int resolution = 0;
  int blocks_per_side = 0;
  std::vector<std::uint32_t> block_of_slot;  // y * blocks_per_side + x
  std::vector<std::uint64_t> surface_mask;   // one per slot: bit (y*8+x)
  // 64 per slot; undefined if the texel is not a surface texel
  std::vector<std::uint32_t> triangle;
  // 64 per slot: second corner in the low, third corner in the high 16 bits, in 1/65535
  std::vector<std::uint32_t> weights;
  struct Gutter {
    // a gutter texel and the surface texel that it follows, as indices into the per-slot arrays
    std::uint32_t texel, owner;
  };
  std::vector<Gutter> gutter;

  glm::vec3 weights_of(std::size_t texel) const {
    const float b = static_cast<float>(weights[texel] & 0xffff) / 65535.0f,
                c = static_cast<float>(weights[texel] >> 16) / 65535.0f;
    return {std::max(0.0f, 1 - b - c), b, c};
  }
};

// Fails when cancelled, or if the resolution is not a multiple of 128 in the range 128…16384.
Result<TexelOwners> bake_texel_owners(const Geometry& geometry, int resolution, Progress& progress,
                                      int threads = background_threads());

// Calls `visit(texel)` for every surface texel on several threads at the same time, and reports
// `message`. `texel` is an index into the per-slot arrays. One thread visits a range of
// kTexelsAtOnce texels in order. A range begins at a multiple of kTexelsAtOnce. Fails when
// cancelled.
constexpr std::size_t kTexelsAtOnce = 256 * 64;
using TexelVisit = std::function<void(std::size_t texel)>;
Result<void> for_each_texel(const TexelOwners& owners, const TexelVisit& visit, const char* message,
                            Progress& progress, int threads = background_threads());

// Paints the surface. Each texel gets the bits of the layer's value that `bits_at` returns for it,
// or stays empty. Gutter texels follow their owners. `bits_at` is called like `visit` above.
using TexelBits = std::function<std::optional<std::uint32_t>(std::size_t texel)>;
Result<TileMap> paint_texels(const TexelOwners& owners, ValueType type, const TexelBits& bits_at,
                             Progress& progress, int threads = background_threads());

}  // namespace strata::mesh
