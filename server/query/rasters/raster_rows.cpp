#include "query/rasters/raster_rows.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "domain/people/question.h"

namespace strata::query {
namespace {

int tiles_per_side(const Layer& layer) { return (layer.resolution + kTileSize - 1) / kTileSize; }

}  // namespace

TileRows::TileRows(const Layer& layer, const TileMap& tiles)
    : resolution_(layer.resolution), tiles_per_side_(tiles_per_side(layer)) {
  tiles_.resize(std::size_t(tiles_per_side_) * tiles_per_side_);
  for (const auto& [address, tile] : tiles)
    if (address.x < tiles_per_side_ && address.y < tiles_per_side_)
      tiles_[std::size_t(address.y) * tiles_per_side_ + address.x] = tile.get();
}

void TileRows::read(int file_row, std::span<std::uint32_t> bits,
                    std::span<std::uint8_t> valid) const {
  check_question();
  std::fill(bits.begin(), bits.end(), 0u);
  std::fill(valid.begin(), valid.end(), std::uint8_t{0});
  const int y = resolution_ - 1 - file_row;
  for (int tile_x = 0; tile_x < tiles_per_side_; ++tile_x) {
    const TileData* tile = tiles_[std::size_t(y / kTileSize) * tiles_per_side_ + tile_x];
    if (tile == nullptr) continue;
    const int first = tile_x * kTileSize, end = std::min(resolution_, first + kTileSize);
    for (int x = first; x < end; ++x) {
      const int texel = y % kTileSize * kTileSize + (x - first);
      if (!tile->valid.test(texel)) continue;
      bits[x] = tile->bits(texel);
      valid[x] = 1;
    }
  }
}

TileMapBuilder::TileMapBuilder(const Layer& layer)
    : type_(layer.type),
      bytes_(bytes_per_texel(layer.type)),
      resolution_(layer.resolution),
      tiles_per_side_(tiles_per_side(layer)) {
  tiles_.resize(std::size_t(tiles_per_side_) * tiles_per_side_);
}

Result<void> TileMapBuilder::put(int x, int file_row, const std::uint8_t* value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, value, bytes_);
  if (is_float(type_) && !std::isfinite(decode_value(type_, bits)))
    return refuse_raster("The value in column " + std::to_string(x) + " of row " +
                         std::to_string(file_row) +
                         " is not a finite number. Mark such texels as invalid.");
  const int y = resolution_ - 1 - file_row;
  auto& tile = tiles_[std::size_t(y / kTileSize) * tiles_per_side_ + x / kTileSize];
  if (!tile) tile = std::make_shared<TileData>(type_);
  tile->write(y % kTileSize * kTileSize + x % kTileSize, bits);
  return {};
}

TileMap TileMapBuilder::finish() {
  TileMap tiles;
  for (std::size_t i = 0; i < tiles_.size(); ++i) {
    const TileAddress address{static_cast<std::uint16_t>(i % tiles_per_side_),
                              static_cast<std::uint16_t>(i / tiles_per_side_)};
    if (tiles_[i]) tiles.emplace(address, std::move(tiles_[i]));
  }
  return tiles;
}

tl::unexpected<Error> refuse_raster(std::string detail) {
  return fail(ErrorCode::invalid, "Raster not accepted", std::move(detail), "texels");
}

std::string raster_needs(const Layer& layer) {
  const std::string side = std::to_string(layer.resolution);
  return side + " × " + side + " texels of " + std::string(name(layer.type));
}

Result<void> check_raster_size(const Layer& layer, std::uint64_t width, std::uint64_t height) {
  const auto side = static_cast<std::uint64_t>(layer.resolution);
  if (width == side && height == side) return {};
  return refuse_raster(
      "The file is " + std::to_string(width) + " × " + std::to_string(height) +
      ", but the layer needs " + raster_needs(layer) +
      ". Resample the file, or export the layer first to see the required format.");
}

}  // namespace strata::query
