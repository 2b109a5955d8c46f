#pragma once

#include <functional>
#include <optional>
#include <span>

#include "core/progress.h"
#include "mesh/rollout/rollout_rays.h"

namespace strata::mesh {

// A window of a sheet, divided into square pixels.
struct RolloutWindow {
  glm::dvec2 top_left{0};  // on the sheet
  double units_per_pixel = 1;
  int width = 0, height = 0;  // in pixels

  glm::dvec2 center_of(int column, int row) const {
    return top_left + units_per_pixel * glm::dvec2(column + 0.5, -(row + 0.5));
  }
};
// Returns the window that contains the whole sheet, with at least one pixel per side.
RolloutWindow window_of(const RolloutSheet& sheet, double units_per_pixel);
// Returns the number of pixels of such a window, which may exceed the largest int.
double pixels_of(const RolloutSheet& sheet, double units_per_pixel);

// Receives the pixels of a row from the left. Called from several threads, once for each row.
using SeeRolloutRow =
    std::function<void(int row, std::span<const std::optional<RolloutHit>> pixels)>;

// Casts a ray through the center of each pixel (RolloutRays::cast). `tree` and `sheet` are of
// `geometry`. Runs on several threads, with the memory of one row for each. Checks the current
// question. Returns `cancelled` after a cancellation.
Result<void> trace_rollout(const SearchTree& tree, const Geometry& geometry,
                           const RolloutSheet& sheet, const RolloutWindow& window,
                           const SeeRolloutRow& see, Progress& progress);

}  // namespace strata::mesh
