#pragma once

#include <glm/glm.hpp>
#include <string>

#include "domain/scene/camera.h"
#include "mesh/surface/geometry.h"

namespace strata::bench {

// How a model stands before who looks at it. Without a turn its front is where an importer of its
// format expects it: south of a map where z is up, +z where y is up.
struct Standing {
  std::string up = "z";       // "x", "y" or "z"
  double turned_degrees = 0;  // of its front to the right, seen from above
};

// `up` as the file or a person says it; where that is empty, what is known of the scans of the data
// folder, of which PLY, OBJ and STL cannot say it; z otherwise. The front is always that of the
// known scan. `title`: see mesh_title.
Standing standing_of(const std::string& title, const std::string& up);

// SurfaceImages at a model that stands so, from a direction of its own (to its right, before it,
// above it), so that it fills the square picture up to a margin, whatever its shape. The direction
// is not straight up or down.
Camera fitted_camera(const mesh::Geometry& geometry, const Standing& standing, glm::dvec3 from,
                     int side);

}  // namespace strata::bench
