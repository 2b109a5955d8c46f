#include "render/edit/edit_kernel.h"

#include <chrono>
#include <limits>

#include "mesh/parallel.h"

namespace strata::render {
namespace {

// The time before other threads start. A small stroke is complete before this time has passed.
constexpr std::chrono::microseconds kAlone(200);

using Clock = std::chrono::steady_clock;

struct TileResult {
  TileMask written;
  glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};
  std::size_t tested_blocks = 0;
  bool any = false;
};

void put(std::uint64_t bits, std::uint32_t block_in_tile, TileMask& mask) {
  const std::uint32_t first =
      (block_in_tile >> 4) * kBlockSize * kTileSize + (block_in_tile & 15) * kBlockSize;
  for (std::uint32_t row = 0; row < kBlockSize; ++row) {
    const std::uint32_t texel = first + row * kTileSize;
    mask.words[texel / 64] |= (bits >> (row * kBlockSize) & 0xffu) << (texel % 64);
  }
}

}  // namespace

KernelResult run_edit_kernel(const mesh::SurfaceMap& map, const BlockCuller& culler,
                             const BlockTest& test, TestBlock test_block, int threads) {
  const TouchedParts touched = culler.find(threads);
  const auto& tiles = touched.tiles;
  std::vector<TileResult> results(tiles.size());
  const auto test_tile = [&](std::size_t index) {
    Candidates candidates;
    candidates.blocks.reserve(tiles[index].count);
    culler.add_blocks(touched, tiles[index], candidates);
    TileResult& result = results[index];
    result.tested_blocks = candidates.blocks.size();
    for (const CandidateBlock& block : candidates.blocks) {
      const auto segments = candidates.segment_lists.at(block.segments, block.segment_count);
      std::uint64_t bits =
          test_block(test, map.packed_position.data() + std::size_t{block.slot} * 64,
                     map.packed_box[block.slot], segments, block.in_tool);
      if (test.hidden_parts.any()) bits &= ~map.texels_of_parts(block.slot, test.hidden_parts);
      if (bits == 0) continue;
      put(bits, block.block_in_tile, result.written);
      const auto& bounds = block.bounds(map);
      result.low = glm::min(result.low, bounds.center - bounds.radius);
      result.high = glm::max(result.high, bounds.center + bounds.radius);
      result.any = true;
    }
  };
  std::size_t next = 0;
  for (const auto begin = Clock::now(); next < tiles.size() && Clock::now() - begin < kAlone;
       ++next)
    test_tile(next);
  mesh::parallel_for(threads, static_cast<int>(tiles.size() - next),
                     [&](int number) { test_tile(next + static_cast<std::size_t>(number)); });

  KernelResult found;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const TileResult& result = results[i];
    found.tested_blocks += result.tested_blocks;
    if (!result.any) continue;
    found.written_min = found.tiles.empty() ? result.low : glm::min(found.written_min, result.low);
    found.written_max =
        found.tiles.empty() ? result.high : glm::max(found.written_max, result.high);
    found.tiles.push_back({tiles[i].address, result.written});
  }
  return found;
}

}  // namespace strata::render
