#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mesh/texels/texel_graph.h"
#include "query/regions/surface_values.h"
#include "query/regions/texel_discs.h"

namespace strata {
class Progress;
}

namespace strata::query {

// Runs of connected texels in the rows of the atlas, with prefix sums of their areas. The area of
// any part of a row with few values is found in a few steps.
//
// Areas are whole numbers of 1/4096 of the mean area of a texel. Their sums are exact, so equal
// areas stay equal in any order of addition.
class RowRuns {
 public:
  // Incomplete when cancelled.
  RowRuns(const SurfaceValues& values, const mesh::SurfaceMap& map, const mesh::TexelGraph& graph,
          const Progress& progress, int threads);

  std::uint32_t texel_at(int x, int y) const { return texel_in_atlas(map_, x, y); }

  std::uint32_t area(std::uint32_t texel) const {
    // Far larger texels than the mean are rare. The bound keeps sums within 32 bits.
    return static_cast<std::uint32_t>(
        std::min(std::lround(map_.area[texel] * steps_per_area_), kMaxArea));
  }

  // Returns whether the texels x0…x1 of a row are all connected to each other along the row.
  bool are_connected(int y, int x0, int x1) const {
    if (y < 0 || x0 < 0 || y >= map_.resolution || x1 >= map_.resolution) return false;
    const std::uint32_t texel = texel_at(x0, y);
    return texel != mesh::kNoNeighbour && chart_end_[texel] >= x1;
  }

  // Calls add(value, area) for each run of the texels x0…x1 of a row. Returns false if these texels
  // are not all connected.
  template <class Add>
  bool for_each_run(int y, int x0, int x1, Add&& add) const {
    if (!are_connected(y, x0, x1)) return false;
    std::uint32_t texel = texel_at(x0, y);
    while (true) {
      const int end = std::min<int>(value_end_[texel], x1);
      const std::uint32_t last = texel_at(end, y);
      add(values_.of(texel), area_before_[last] + area(last) - area_before_[texel]);
      if (end == x1) return true;
      texel = texel_at(end + 1, y);
    }
  }

 private:
  static constexpr long kMaxArea = 1 << 24;
  void find_runs(int y);

  const SurfaceValues& values_;
  const mesh::SurfaceMap& map_;
  const mesh::TexelGraph& graph_;
  const double steps_per_area_;
  // By texel: the column of the last texel of its row that is connected to it, and the last one
  // that also has its value. Sums of areas from the first such texel to the one before it, modulo
  // 2³².
  std::vector<std::uint16_t> chart_end_, value_end_;
  std::vector<std::uint32_t> area_before_;
};

}  // namespace strata::query
