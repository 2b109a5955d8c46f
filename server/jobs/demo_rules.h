#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::jobs {

// The values of the demo's two layers at a point of the pot. The pot is broken along the borders of
// cells around seeds: sherds are cells with borders made rough by noise, as seen from the pot's
// middle, so that a sherd extends through the wall. Cracks are bands along some of these borders;
// hairlines are borders of smaller cells, drawn in part, so that they branch and end.
// Deterministic.
class DemoRules {
 public:
  static constexpr int kSherds = 14;
  enum Crack : std::uint8_t { none = 0, hairline = 1, crack = 2, open_crack = 3 };

  // Points of the surface in any order, model units, from which the seeds are chosen evenly; at
  // least kSherds points.
  explicit DemoRules(std::span<const glm::vec3> surface);

  struct Marks {
    std::uint8_t sherd = 1;  // 1…kSherds
    Crack crack = none;
  };
  Marks at(const glm::vec3& position) const;

 private:
  glm::dvec3 towards(const glm::vec3& position) const;

  glm::dvec3 center_{0};
  double radius_ = 1;  // of the sphere around the middle on which cells are measured
  std::vector<glm::dvec3> sherd_seeds_, craze_seeds_;
};

}  // namespace strata::jobs
