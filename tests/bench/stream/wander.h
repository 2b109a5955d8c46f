#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <random>

namespace strata::bench {

// A pointer that paints endlessly in the middle of a window, where models are. It moves 12 pixels
// in each step, which is 400 pixels a second with steps of 30 ms.
class Wander {
 public:
  Wander(int width, int height, unsigned seed)
      : low_(0.34 * width, 0.28 * height),
        high_(0.66 * width, 0.72 * height),
        at_((low_ + high_) / 2.0),
        random_(seed) {}

  glm::dvec2 at() const { return at_; }
  glm::dvec2 step() {
    heading_ += std::uniform_real_distribution<double>(-0.6, 0.6)(random_);
    const glm::dvec2 next = at_ + 12.0 * glm::dvec2(std::cos(heading_), std::sin(heading_));
    at_ = glm::clamp(next, low_, high_);
    if (at_ != next) heading_ += 2.5;
    return at_;
  }

 private:
  const glm::dvec2 low_, high_;
  glm::dvec2 at_;
  double heading_ = 0;
  std::mt19937 random_;
};

}  // namespace strata::bench
