#include "render/view/depth_copy.h"

#include <algorithm>
#include <cmath>

#include "mesh/parallel.h"
#include "shared/depth_probe.h"

namespace strata::render {
namespace {

constexpr int kCell = static_cast<int>(shader::kDepthCell);

void find_slopes(const float* below, const float* row, const float* above, int width,
                 float* slope) {
  const auto at = [&](int x, int left, int right) {
    return std::min(std::abs(row[x] - row[left]), std::abs(row[right] - row[x])) +
           std::min(std::abs(row[x] - below[x]), std::abs(above[x] - row[x]));
  };
  slope[0] = at(0, 0, std::min(1, width - 1));
  for (int x = 1; x < width - 1; ++x) slope[x] = at(x, x - 1, x + 1);
  slope[width - 1] = at(width - 1, std::max(width - 2, 0), width - 1);
}

}  // namespace

DepthCopy make_depth_copy(std::vector<float> depth, int width, int height, int threads) {
  DepthCopy copy;
  copy.width = width;
  copy.height = height;
  copy.depth = std::move(depth);
  copy.slope.resize(copy.depth.size());
  const int cells_x = depth_cells(width), cells_y = depth_cells(height);
  copy.grid.resize(static_cast<std::size_t>(cells_x) * static_cast<std::size_t>(cells_y));
  const auto row = [&](int y) {
    return copy.depth.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
  };
  mesh::parallel_for(threads, cells_y, [&](int cell_y) {
    float* cells =
        copy.grid.data() + static_cast<std::size_t>(cell_y) * static_cast<std::size_t>(cells_x);
    for (int y = cell_y * kCell; y < std::min((cell_y + 1) * kCell, height); ++y) {
      find_slopes(row(std::max(y - 1, 0)), row(y), row(std::min(y + 1, height - 1)), width,
                  copy.slope.data() + (row(y) - copy.depth.data()));
      for (int x = 0; x < cells_x; ++x) {
        const float* first = row(y) + x * kCell;
        cells[x] = std::max(cells[x],
                            *std::max_element(first, first + std::min(kCell, width - x * kCell)));
      }
    }
  });
  return copy;
}

}  // namespace strata::render
