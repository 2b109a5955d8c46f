#include "mesh/texels/texel_owners.h"

#include <atomic>
#include <bit>
#include <mutex>
#include <unordered_map>

#include "mesh/texels/surface_bake.h"

namespace strata::mesh {
namespace {

constexpr int kBlocksPerTileSide = kTileSize / kBlockSize;
constexpr const char* kLocating = "Locating texels on the surface";

// Collects the values computed for the texels of all slots into tiles.
class TileSorter {
 public:
  TileSorter(const TexelOwners& owners, ValueType type) : owners_(owners), type_(type) {
    const auto slots = static_cast<std::uint32_t>(owners.block_of_slot.size());
    for (std::uint32_t slot = 0; slot < slots; ++slot) {
      const auto block = owners.block_of_slot[slot];
      const auto x = block % owners.blocks_per_side, y = block / owners.blocks_per_side;
      slots_[{static_cast<std::uint16_t>(x / kBlocksPerTileSide),
              static_cast<std::uint16_t>(y / kBlocksPerTileSide)}]
          .push_back(slot);
    }
  }

  TileMap sort(const std::vector<std::uint32_t>& bits,
               const std::vector<std::uint64_t>& valid) const {
    TileMap tiles;
    for (const auto& [address, slots] : slots_) {
      TileData tile(type_);
      for (const std::uint32_t slot : slots) {
        const auto block = owners_.block_of_slot[slot];
        const auto bx = static_cast<int>(block % owners_.blocks_per_side) % kBlocksPerTileSide,
                   by = static_cast<int>(block / owners_.blocks_per_side) % kBlocksPerTileSide;
        for (std::uint64_t left = valid[slot]; left; left &= left - 1) {
          const int i = std::countr_zero(left);
          tile.write(
              (by * kBlockSize + i / kBlockSize) * kTileSize + bx * kBlockSize + i % kBlockSize,
              bits[std::size_t{slot} * 64 + i]);
        }
      }
      if (tile.valid.any()) tiles[address] = std::make_shared<const TileData>(std::move(tile));
    }
    return tiles;
  }

 private:
  const TexelOwners& owners_;
  const ValueType type_;
  std::unordered_map<TileAddress, std::vector<std::uint32_t>> slots_;
};

}  // namespace

Result<TexelOwners> bake_texel_owners(const Geometry& geometry, int resolution, Progress& progress,
                                      int threads) {
  STRATA_TRY(check_map_resolution(resolution));
  SurfaceMap map;
  progress.report(0, kLocating);
  SurfaceBake bake(geometry, resolution, map, BakeFor::owners);
  const auto on_bands = [&](double from, double to, auto work) {
    std::atomic<int> done{0};
    parallel_for(threads, bake.band_count(), [&](int band) {
      if (progress.cancelled()) return;
      work(band);
      progress.report(from + (to - from) * ++done / bake.band_count(), kLocating);
    });
    return !progress.cancelled();
  };
  if (!on_bands(0.1, 0.3, [&](int band) { bake.mark_surface(band); })) return cancelled_problem();
  if (!on_bands(0.3, 0.4, [&](int band) { bake.mark_gutter(band); })) return cancelled_problem();
  bake.assign_slots(threads);
  if (!on_bands(0.45, 0.9, [&](int band) { bake.place_surface(band); })) return cancelled_problem();
  if (!on_bands(0.9, 1, [&](int band) { bake.place_gutter(band); })) return cancelled_problem();

  TexelOwners owners;
  owners.resolution = resolution;
  owners.blocks_per_side = map.blocks_per_side;
  owners.block_of_slot = std::move(map.block_of_slot);
  owners.surface_mask = std::move(map.surface_mask);
  owners.triangle = bake.take_owners();
  owners.weights = bake.take_weights();
  std::size_t gutter = 0;
  for (int band = 0; band < bake.band_count(); ++band) gutter += bake.borrowed_in(band).size();
  owners.gutter.reserve(gutter);
  for (int band = 0; band < bake.band_count(); ++band)
    for (const auto& [texel, owner] : bake.borrowed_in(band))
      owners.gutter.push_back({texel, owner});
  progress.report(1, kLocating);
  return owners;
}

Result<void> for_each_texel(const TexelOwners& owners, const TexelVisit& visit, const char* message,
                            Progress& progress, int threads) {
  constexpr auto kSlotsAtOnce = static_cast<std::uint32_t>(kTexelsAtOnce / 64);
  const auto slots = static_cast<std::uint32_t>(owners.block_of_slot.size());
  std::mutex mutex;
  std::uint32_t done = 0;
  parallel_for(threads, static_cast<int>((slots + kSlotsAtOnce - 1) / kSlotsAtOnce), [&](int part) {
    const std::uint32_t first = part * kSlotsAtOnce, last = std::min(slots, first + kSlotsAtOnce);
    for (std::uint32_t slot = first; slot < last && !progress.cancelled(); ++slot)
      for (std::uint64_t left = owners.surface_mask[slot]; left; left &= left - 1)
        visit(std::size_t{slot} * 64 + std::countr_zero(left));
    std::lock_guard lock(mutex);
    done += last - first;
    progress.report(static_cast<double>(done) / slots, message);
  });
  if (progress.cancelled()) return cancelled_problem();
  return {};
}

Result<TileMap> paint_texels(const TexelOwners& owners, ValueType type, const TexelBits& bits_at,
                             Progress& progress, int threads) {
  std::vector<std::uint32_t> bits(owners.triangle.size());
  std::vector<std::uint64_t> valid(owners.block_of_slot.size(), 0);
  const auto paint = [&](std::size_t texel) {
    const auto value = bits_at(texel);
    if (!value) return;
    bits[texel] = *value;
    valid[texel / 64] |= std::uint64_t{1} << (texel % 64);  // only one thread writes to a slot
  };
  STRATA_TRY(for_each_texel(owners, paint, "Painting", progress, threads));
  for (const auto& [texel, owner] : owners.gutter) {
    if (!(valid[owner / 64] >> (owner % 64) & 1)) continue;
    bits[texel] = bits[owner];
    valid[texel / 64] |= std::uint64_t{1} << (texel % 64);
  }
  return TileSorter(owners, type).sort(bits, valid);
}

}  // namespace strata::mesh
