#pragma once

#include <glm/glm.hpp>
#include <string>

#include "domain/scene/camera.h"
#include "mesh/surface/geometry.h"

namespace strata::bench {

// Orientation of a model for an observer in front of it. Without a turn its front is the one that
// an importer of its format assumes: south of a map if z is up, +z if y is up.
struct Standing {
  std::string up = "z";       // "x", "y" or "z"
  double turned_degrees = 0;  // of its front to the right, seen from above
};

// `up` is from the file or a person. If it is empty: the axis of known scans of the data folder,
// which PLY, OBJ and STL do not contain; otherwise z. The front is always that of the known scan.
// `title`: see mesh_title.
Standing standing_of(const std::string& title, const std::string& up);

// Returns a camera that sees the oriented model from a direction in the model's own axes (to its
// right, in front of it, above it), at the distance where any shape fills the square picture up to
// a margin. The direction is not straight up or down.
Camera fitted_camera(const mesh::Geometry& geometry, const Standing& standing, glm::dvec3 from,
                     int side);

}  // namespace strata::bench
