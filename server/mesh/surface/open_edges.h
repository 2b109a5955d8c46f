#pragma once

#include "domain/scene/model.h"
#include "mesh/surface/geometry.h"

namespace strata::mesh {

// Where the surface ends, in file units: the loops of `boundary_loops`, measured. For its time and
// memory see Connectivity.
OpenEdges measure_open_edges(const Geometry& geometry);

}  // namespace strata::mesh
