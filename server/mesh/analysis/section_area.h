#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "mesh/surface/geometry.h"

namespace strata::mesh {

// The section of the model by one plane, limited to the side that the other planes keep.
struct CutArea {
  // in unit²; empty if the outline is open, because it then bounds no area
  std::optional<double> area;
};

// Measures the areas where `planes` cut a model, in the order of the planes. The planes are in
// world coordinates (see Camera::section). The pieces of the outline are summed with their
// direction. Holes are therefore subtracted, and the result does not depend on the winding of a
// closed surface. Gaps with a total length of at most 1 % of the outline are closed by straight
// lines. Checks the current question (domain/people/question.h). A plane takes a few milliseconds
// per million triangles.
std::vector<CutArea> cut_areas(const Geometry& geometry, std::span<const glm::dvec4> planes);

}  // namespace strata::mesh
