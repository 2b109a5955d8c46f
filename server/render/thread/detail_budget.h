#pragma once

#include <cstddef>
#include <span>

namespace strata::render {

// Chooses the level of detail of a model while its camera moves: the finest level that can be drawn
// in a few milliseconds, by the times of earlier drawings on this GPU.
class DetailBudget {
 public:
  DetailBudget() = default;
  explicit DetailBudget(bool software);

  // `triangles`: triangles of each level in the window, the finest first. Returns the coarsest if
  // none fits.
  int choose(std::span<const std::size_t> triangles) const;
  void drawn(std::size_t triangles, double ms);

 private:
  double ns_per_triangle_ = 0;
};

}  // namespace strata::render
