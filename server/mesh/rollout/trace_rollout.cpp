#include "mesh/rollout/trace_rollout.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mesh/parallel.h"

namespace strata::mesh {
namespace {

constexpr int kRowsAtOnce = 64;  // between two reports

// Returns the size in whole pixels. A border narrower than a hundredth of a pixel gets no pixels,
// so a rounding error adds no empty row.
glm::dvec2 size_of(const RolloutSheet& sheet, double units_per_pixel) {
  constexpr double kNoPixel = 0.01;
  return glm::max(glm::ceil((sheet.max - sheet.min) / units_per_pixel - kNoPixel), 1.0);
}

}  // namespace

double pixels_of(const RolloutSheet& sheet, double units_per_pixel) {
  const glm::dvec2 size = size_of(sheet, units_per_pixel);
  return size.x * size.y;
}

RolloutWindow window_of(const RolloutSheet& sheet, double units_per_pixel) {
  const glm::dvec2 size = size_of(sheet, units_per_pixel);
  return {{sheet.min.x, sheet.max.y},
          units_per_pixel,
          static_cast<int>(size.x),
          static_cast<int>(size.y)};
}

Result<void> trace_rollout(const SearchTree& tree, const Geometry& geometry,
                           const RolloutSheet& sheet, const RolloutWindow& window,
                           const SeeRolloutRow& see, Progress& progress) {
  const RolloutRays rays(tree, geometry, sheet);
  for (int first = 0; first < window.height; first += kRowsAtOnce) {
    if (progress.cancelled()) return cancelled_problem();
    parallel_for(background_threads(), std::min(kRowsAtOnce, window.height - first), [&](int i) {
      const int row = first + i;
      std::vector<std::optional<RolloutHit>> pixels(static_cast<std::size_t>(window.width));
      for (int column = 0; column < window.width; ++column)
        pixels[static_cast<std::size_t>(column)] = rays.cast(window.center_of(column, row));
      see(row, pixels);
    });
    progress.report(std::min(1.0, static_cast<double>(first + kRowsAtOnce) / window.height),
                    "Unrolling the surface");
  }
  return {};
}

}  // namespace strata::mesh
