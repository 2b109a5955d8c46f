#pragma once

#include <cstddef>
#include <span>

namespace strata::render {

// Chooses a model's level of detail while the camera moves, and the number of samples of a frame.
// It chooses the finest level, and the most samples, that can be drawn within a few milliseconds.
// The estimates are based on the times of earlier drawings on this GPU.
class DetailBudget {
 public:
  DetailBudget() = default;
  explicit DetailBudget(bool software);

  // `triangles` contains the number of triangles of each level in the window, the finest level
  // first. Returns the coarsest level if no level is fast enough.
  int choose(std::span<const std::size_t> triangles) const;
  void drawn(std::size_t triangles, double ms);

  // Returns the number of samples for a frame with smooth edges: kSmoothSamples or 1. A software
  // renderer never has the time for more than one.
  static constexpr int kSmoothSamples = 5;
  int samples(std::size_t pixels);
  // `pixels` is the number of pixels in all samples except the first.
  void smoothed(std::size_t pixels, double ms);

 private:
  bool software_ = false;
  double ns_per_triangle_ = 0;
  double ns_per_pixel_ = 0;  // of a sample
};

}  // namespace strata::render
