#include "render/thread/detail_budget.h"

namespace strata::render {
namespace {

// The time limit for drawing the mesh in one frame of a moving camera. With shading and encoding it
// allows 30 frames per second.
constexpr double kBudgetMs = 10;
// Estimated times per triangle before the first drawing. llvmpipe needs 27 to 59 ns.
constexpr double kNsSoftware = 40, kNsHardware = 1;
// The time of smaller drawings depends less on triangles than on the other costs of a frame.
constexpr std::size_t kFewTriangles = 50'000;
constexpr double kShareOfNew = 0.2;
// The time limit for the samples of a frame after the first one.
constexpr double kSmoothBudgetMs = 4;
constexpr double kNsPerPixel = 0.5;  // estimate before the first such frame, on a GPU
// Lowers the estimate after each frame with one sample, so later frames try more samples again.
constexpr double kForgotten = 0.998;

}  // namespace

DetailBudget::DetailBudget(bool software)
    : software_(software),
      ns_per_triangle_(software ? kNsSoftware : kNsHardware),
      ns_per_pixel_(kNsPerPixel) {}

int DetailBudget::choose(std::span<const std::size_t> triangles) const {
  for (std::size_t level = 0; level < triangles.size(); ++level) {
    if (static_cast<double>(triangles[level]) * ns_per_triangle_ * 1e-6 <= kBudgetMs)
      return static_cast<int>(level);
  }
  return static_cast<int>(triangles.size()) - 1;
}

void DetailBudget::drawn(std::size_t triangles, double ms) {
  if (triangles < kFewTriangles) return;
  const double ns = ms * 1e6 / static_cast<double>(triangles);
  ns_per_triangle_ += kShareOfNew * (ns - ns_per_triangle_);
}

int DetailBudget::samples(std::size_t pixels) {
  if (software_) return 1;
  const double ms = static_cast<double>(pixels) * (kSmoothSamples - 1) * ns_per_pixel_ * 1e-6;
  if (ms <= kSmoothBudgetMs) return kSmoothSamples;
  ns_per_pixel_ *= kForgotten;
  return 1;
}

void DetailBudget::smoothed(std::size_t pixels, double ms) {
  if (pixels == 0) return;
  ns_per_pixel_ += kShareOfNew * (ms * 1e6 / static_cast<double>(pixels) - ns_per_pixel_);
}

}  // namespace strata::render
