#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The cut of one plane of a section, inside what the other planes keep.
struct CutArea {
  // unit²; nothing where the surface is open at the cut, so that it bounds no area
  std::optional<double> area;
};

// Measures the cuts of a model that `planes` (world coordinates; Camera::section) cut open, in
// their order. Sums the pieces of the outline with their direction, so holes count as holes, and
// the result does not depend on the winding of a closed surface. Gaps of at most 1 % of the outline
// are closed by straight lines. Checks the current question (domain/people/question.h). A few
// milliseconds for a million triangles and plane.
std::vector<CutArea> cut_areas(const Geometry& geometry, std::span<const glm::dvec4> planes);

}  // namespace strata::mesh
