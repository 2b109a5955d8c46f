#pragma once

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Computes the demo model from formulas: a thick-walled pot with relief, a broken rim and a missing
// sherd. The mesh is closed and manifold and has vertex colors. Its size is about 105 × 99 × 91 mm,
// and it has about 200 000 triangles at detail 1. Tests use fewer triangles. The result is
// deterministic.
TriangleMesh make_demo_pot(double detail = 1.0);

}  // namespace strata::mesh
