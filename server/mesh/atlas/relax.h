#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace strata::mesh {

// A piece of a chart whose inner vertices may move in the plane to bring its triangles near their
// true shapes.
struct RelaxPatch {
  struct Face {
    std::uint32_t vertex[3];  // into `points`
    // the true shape, in the scale of the plane: corners at (0, 0), b and c; counterclockwise
    glm::vec2 b, c;
  };
  std::vector<glm::vec2> points;
  std::vector<std::uint8_t> is_fixed;  // one entry a point
  std::vector<Face> faces;
};

// Moves points that are not fixed, one after the other, down a distortion energy that also unfolds
// flipped triangles (Garanzha, Kaporin, Kudryavtseva, Protais, Ray, Sokolov: Foldover-free maps in
// 50 lines of code, 2021). It weights shape and area, area most. Ends when no triangle has less
// than `good_area` times its true area, or after `most_sweeps`.
void relax(RelaxPatch& patch, float good_area, int most_sweeps);

}  // namespace strata::mesh
