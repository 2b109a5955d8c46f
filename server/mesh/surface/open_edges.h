#pragma once

#include "domain/scene/model.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Measures where the surface ends, in file units: the loops of `boundary_loops`. For time and
// memory see Connectivity.
OpenEdges measure_open_edges(const Geometry& geometry);

}  // namespace strata::mesh
