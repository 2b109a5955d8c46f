#include "query/regions/row_runs.h"

#include "core/progress.h"
#include "mesh/parallel.h"

namespace strata::query {

RowRuns::RowRuns(const SurfaceValues& values, const mesh::SurfaceMap& map,
                 const mesh::TexelGraph& graph, const Progress& progress, int threads)
    : values_(values),
      map_(map),
      graph_(graph),
      steps_per_area_(
          map.area_total > 0 ? 4096 * static_cast<double>(map.surface_texels) / map.area_total : 0),
      chart_end_(map.block_of_slot.size() * 64),
      value_end_(map.block_of_slot.size() * 64),
      area_before_(map.block_of_slot.size() * 64) {
  mesh::parallel_for(threads, map.blocks_per_side, [&](int block_y) {
    if (progress.cancelled()) return;
    for (int y = block_y * kBlockSize; y < (block_y + 1) * kBlockSize; ++y) find_runs(y);
  });
}

void RowRuns::find_runs(int y) {
  const auto goes_right = [&](std::uint32_t texel) {
    return (graph_.to_right[texel / 64] >> texel % 64 & 1u) != 0;
  };
  const auto for_each_in_row = [&](bool rightwards, auto&& visit) {
    const int blocks = map_.blocks_per_side;
    for (int i = 0; i < blocks; ++i) {
      const int block_x = rightwards ? i : blocks - 1 - i;
      if (map_.slot_of_block[static_cast<std::size_t>(y / kBlockSize) *
                                 static_cast<std::size_t>(blocks) +
                             static_cast<std::size_t>(block_x)] == mesh::kNoSlot)
        continue;
      for (int k = 0; k < kBlockSize; ++k) {
        const int x = block_x * kBlockSize + (rightwards ? k : kBlockSize - 1 - k);
        if (const std::uint32_t texel = texel_at(x, y); texel != mesh::kNoNeighbour)
          visit(texel, x);
      }
    }
  };
  std::uint32_t before = mesh::kNoNeighbour;  // the texel that was visited before
  for_each_in_row(true, [&](std::uint32_t texel, int) {
    const bool connected = before != mesh::kNoNeighbour && goes_right(before);
    area_before_[texel] = connected ? area_before_[before] + area(before) : 0;
    before = texel;
  });
  before = mesh::kNoNeighbour;
  for_each_in_row(false, [&](std::uint32_t texel, int x) {
    const bool connected = goes_right(texel);
    const auto column = static_cast<std::uint16_t>(x);
    chart_end_[texel] = connected ? chart_end_[before] : column;
    value_end_[texel] = connected && values_.same(texel, before) ? value_end_[before] : column;
    before = texel;
  });
}

}  // namespace strata::query
