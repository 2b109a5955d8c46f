#pragma once

#include "mesh/surface/triangle_mesh.h"

namespace strata::mesh {

// Makes the demo model by formula: a thick-walled pot with relief, a broken rim and a missing
// sherd, closed and manifold, about 200 000 triangles at detail 1 (fewer for tests), about 105 × 99
// × 91 mm, with vertex colors. Deterministic.
TriangleMesh make_demo_pot(double detail = 1.0);

}  // namespace strata::mesh
