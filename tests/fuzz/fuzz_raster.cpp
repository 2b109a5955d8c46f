// Fuzzes the texels of a layer of 128², as TIFF, PNG or NumPy. The first byte selects the layer's
// type. A decoded raster must stay the same when it is written and read in any format that can
// store it.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "query/rasters/raster.h"

namespace {

using namespace strata;

void demand(bool holds) {
  if (!holds) std::abort();
}

// Pads a NumPy file of version 1 with zero texels, because few inputs are as long as a layer.
std::vector<std::uint8_t> with_all_texels(std::span<const std::uint8_t> bytes, const Layer& layer) {
  std::vector<std::uint8_t> whole(bytes.begin(), bytes.end());
  const std::size_t header = bytes.size() < 10 ? 0 : std::size_t{10} + bytes[8] + 256u * bytes[9];
  whole.resize(std::max(whole.size(),
                        header + std::size_t{kTexelsPerTile} *
                                     static_cast<std::size_t>(bytes_per_texel(layer.type) + 1)));
  return whole;
}

bool are_equal(const TileMap& a, const TileMap& b) {
  if (a.size() != b.size()) return false;
  for (const auto& [address, tile] : a) {
    const auto other = b.find(address);
    if (other == b.end() || !(*other->second == *tile)) return false;
  }
  return true;
}

void check(const Layer& layer, const TileMap& tiles) {
  for (const auto& [address, tile] : tiles) demand(address == TileAddress{} && tile->valid.any());
  const auto tiff = query::encode_tiff(layer, tiles);
  demand(tiff.has_value());
  const auto from_tiff = query::decode_tiff(layer, *tiff);
  demand(from_tiff.has_value() && are_equal(*from_tiff, tiles));
  const auto npy = query::encode_npy(layer, tiles);
  demand(npy.has_value());
  const auto from_npy = query::decode_npy(layer, *npy);
  demand(from_npy.has_value() && are_equal(*from_npy, tiles));
  if (const auto png = query::encode_png(layer, tiles)) {
    const auto from_png = query::decode_png(layer, *png);
    demand(from_png.has_value() && are_equal(*from_png, tiles));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 5) return 0;
  Layer layer;
  layer.name = "fuzz";
  layer.type = static_cast<ValueType>(data[0] % 8);
  layer.resolution = kTileSize;
  const std::span<const std::uint8_t> bytes(data + 1, size - 1);
  if (const auto tiles = query::decode_tiff(layer, bytes)) check(layer, *tiles);
  if (const auto tiles = query::decode_png(layer, bytes)) check(layer, *tiles);
  if (const auto tiles = query::decode_npy(layer, with_all_texels(bytes, layer)))
    check(layer, *tiles);
  return 0;
}
