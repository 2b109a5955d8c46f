#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "mesh/texels/texel_raster.h"

namespace strata::mesh {

// The texels covered by the faces of one growing chart. A chart uses them to refuse faces that
// share a texel. Chart coordinates are in texels relative to the center of a square window of
// `side` texels. Faces that extend beyond the window are refused.
class Occupancy {
 public:
  explicit Occupancy(int side) : side_(side), stamps_(static_cast<std::size_t>(side) * side, 0) {}

  enum class Overlap { refuse, allow };

  // Clears all texels in constant time.
  void clear() { ++stamp_; }

  // Returns true if the triangle is inside the window and covers no center of an occupied texel.
  bool is_free(glm::vec2 a, glm::vec2 b, glm::vec2 c);

  // Occupies the texels with centers inside the triangle. With Overlap::refuse it occupies them
  // only if all of them are free.
  bool claim(glm::vec2 a, glm::vec2 b, glm::vec2 c, Overlap overlap = Overlap::refuse);

 private:
  struct Span {
    std::uint32_t begin, end;  // of stamps_
  };
  bool holds(glm::vec2 a, glm::vec2 b, glm::vec2 c) const;
  bool find_spans(glm::vec2 a, glm::vec2 b, glm::vec2 c, Overlap overlap);

  const int side_;
  std::uint32_t stamp_ = 1;
  std::vector<std::uint32_t> stamps_;
  std::vector<Span> spans_;  // of the current triangle
};

}  // namespace strata::mesh
