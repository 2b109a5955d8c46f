#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::mesh {

// A piece of a chart with inner vertices that may move in the plane. The moves bring its triangles
// close to their true shapes.
struct RelaxPatch {
  struct Face {
    std::uint32_t vertex[3];  // into `points`
    // the true shape, in the scale of the plane: corners at (0, 0), b and c; counterclockwise
    glm::vec2 b, c;
  };
  std::vector<glm::vec2> points;
  std::vector<std::uint8_t> is_fixed;  // one entry per point
  std::vector<Face> faces;
};

// Moves the points that are not fixed, one by one, to reduce a distortion energy. The energy also
// unfolds flipped triangles (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov: Foldover-free
// maps in 50 lines of code, 2021). It weights shape and area, with more weight on area. Ends when
// no triangle has less than `good_area` times its true area, or after `most_sweeps` sweeps.
void relax(RelaxPatch& patch, float good_area, int most_sweeps);

}  // namespace strata::mesh
