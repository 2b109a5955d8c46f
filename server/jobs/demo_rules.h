#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::jobs {

// Computes the values of the demo's two layers at a point of the pot. The pot is broken along the
// borders of cells around seeds. A sherd is a cell whose border is made rough by noise. The cells
// are measured on a sphere around the pot's center, so a sherd extends through the wall. Cracks are
// bands along some of these borders. Hairlines are bands along some borders of smaller cells, so
// they branch, and some end inside a sherd. Deterministic.
class DemoRules {
 public:
  static constexpr int kSherds = 14;
  enum Crack : std::uint8_t { none = 0, hairline = 1, crack = 2, open_crack = 3 };

  // `surface` contains at least kSherds points of the surface, in model units and in any order. The
  // seeds are chosen evenly from them.
  explicit DemoRules(std::span<const glm::vec3> surface);

  struct Marks {
    std::uint8_t sherd = 1;  // 1…kSherds
    Crack crack = none;
  };
  Marks at(const glm::vec3& position) const;

 private:
  glm::dvec3 towards(const glm::vec3& position) const;

  glm::dvec3 center_{0};
  double radius_ = 1;  // of the sphere on which cells are measured
  std::vector<glm::dvec3> sherd_seeds_, craze_seeds_;
};

}  // namespace strata::jobs
