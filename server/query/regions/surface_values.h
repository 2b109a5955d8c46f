#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/error.h"
#include "domain/layers/tile_mirror.h"
#include "mesh/texels/surface_map.h"

namespace strata {
class Progress;
}

namespace strata::query {

// The value of a texel, or no value.
struct TexelValue {
  std::uint32_t bits = 0;  // 0 without a value
  bool valid = false;
  bool operator==(const TexelValue&) const = default;
};

// The values of one layer at the surface texels of a map with the resolution of the layer. Texels
// are numbered as in TexelGraph. Values are compared by their bits, so they can be numbers or keys.
struct SurfaceValues {
  std::vector<std::uint32_t> bits;   // 64 per slot; 0 for a texel without a value
  std::vector<std::uint64_t> valid;  // per slot: bits of the surface texels with a value

  TexelValue of(std::uint32_t texel) const {
    return {bits[texel], (valid[texel / 64] >> texel % 64 & 1u) != 0};
  }
  bool same(std::uint32_t a, std::uint32_t b) const { return of(a) == of(b); }
  void set(std::uint32_t texel, TexelValue value) {
    const std::uint64_t bit = std::uint64_t{1} << texel % 64;
    bits[texel] = value.valid ? value.bits : 0;
    valid[texel / 64] = value.valid ? valid[texel / 64] | bit : valid[texel / 64] & ~bit;
  }
};

SurfaceValues read_surface_values(const TileMap& tiles, ValueType type,
                                  const mesh::SurfaceMap& map);

// A change of some texels of a layer: surface texels, and the gutter texels that follow them.
struct TexelPatch {
  struct Tile {
    TileMask texels;                                // the texels that change
    std::shared_ptr<const TileData> before, after;  // never null; equal outside `texels`
  };
  std::map<TileAddress, Tile> tiles;
  std::uint64_t texels = 0;  // surface texels that change
  double area = 0;           // area of these texels, in model units²

  bool empty() const { return tiles.empty(); }
};

// Returns the change from the tiles of a layer to `after`. Fails when cancelled.
Result<TexelPatch> make_patch(const TileMap& tiles, ValueType type, const mesh::SurfaceMap& map,
                              SurfaceValues after, const Progress& progress);

// Returns the tiles of a layer with these values. Gutter texels follow the surface texels. Fails
// when cancelled.
Result<TileMap> make_tiles(ValueType type, const mesh::SurfaceMap& map, SurfaceValues values,
                           const Progress& progress);

}  // namespace strata::query
