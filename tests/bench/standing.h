#pragma once

#include <glm/glm.hpp>
#include <string>

#include "domain/scene/camera.h"
#include "mesh/surface/geometry.h"

namespace strata::bench {

// The orientation of a model for an observer in front of it. Without a rotation, the front is the
// side that importers of the format assume: south of a map if z is up, +z if y is up.
struct Standing {
  std::string up = "z";       // "x", "y" or "z"
  double turned_degrees = 0;  // rotation of the front to the right, seen from above
};

// Returns the orientation of a model. `up` is from the file or from a person. If it is empty, known
// scans of the data folder have their known up axis (PLY, OBJ and STL do not store one), and other
// models have z. The front always comes from the known scan. For `title` see mesh_title.
Standing standing_of(const std::string& title, const std::string& up);

// Returns a camera that shows the oriented model from a direction in the model's own axes (right,
// front, up). At its distance, a model of any shape fills the square image up to a margin. The
// direction must not be straight up or down.
Camera fitted_camera(const mesh::Geometry& geometry, const Standing& standing, glm::dvec3 from,
                     int side);

}  // namespace strata::bench
