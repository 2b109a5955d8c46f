#pragma once

#include "mesh/io/load.h"

namespace strata::mesh {

// Orients the triangles so that neighbors agree, and cuts the surface where it is not manifold.
// `loaded.mesh` must be welded, with indices in range, and no triangle may repeat a corner or
// another triangle. The changes are noted.
//
// - At an edge of more than two triangles those two stay joined that agree in direction, are not
//   loose fins and are flattest to each other, and so on; slivers without area that lie on an edge
//   of two others are dropped first.
// - Pieces of the surface follow their majority. Closed ones are turned outward (by signed volume),
//   unless they are hollows: inside the box of a larger closed one and oriented inward by the file.
// - Where a piece cannot be oriented consistently (a Möbius strip) it is cut.
// - Then each vertex whose triangles do not form one fan is copied for each fan.
//
// Refused when cancelled. Progress is reported from `from` to `to`.
Result<void> make_manifold(LoadedMesh& loaded, Progress& progress, double from, double to);

}  // namespace strata::mesh
