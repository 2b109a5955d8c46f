#pragma once

#include <cstddef>
#include <span>

namespace strata::render {

// How fine a model may be drawn while its camera moves: the finest level that fits into a few
// milliseconds, by what drawings of this GPU took before.
class DetailBudget {
 public:
  DetailBudget() = default;
  explicit DetailBudget(bool software);

  // `triangles`: what each level has in the window, the finest first. The coarsest where none fits.
  int choose(std::span<const std::size_t> triangles) const;
  void drawn(std::size_t triangles, double ms);

 private:
  double ns_per_triangle_ = 0;
};

}  // namespace strata::render
