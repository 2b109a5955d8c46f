#pragma once

#include "domain/scene/model.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Measures the loops of `boundary_loops`, where the surface ends, in file units. For time and
// memory see Connectivity.
OpenEdges measure_open_edges(const Geometry& geometry);

}  // namespace strata::mesh
