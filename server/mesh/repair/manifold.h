#pragma once

#include "mesh/io/load.h"

namespace strata::mesh {

// Turns the triangles so that neighbours agree, and cuts the surface where it is no surface.
// `loaded.mesh` is welded, its indices are in range, and no triangle repeats a corner or another
// one. What was done is noted.
//
// - At an edge of more than two triangles those two stay together that agree in direction, are no
// loose fins and lie
//   flattest to each other, and so on; slivers without area that lie on an edge of two others are
//   dropped first.
// - Pieces of the surface follow their majority; closed ones turn outward (by signed volume),
// unless they are hollows: inside
//   the box of a larger closed one and turned inward by the file.
// - Where a piece cannot be turned consistently (a Möbius strip) it is cut.
// - Then each vertex whose triangles do not form one fan is copied for each fan.
//
// Refused when cancelled. Progress is reported from `from` to `to`.
Result<void> make_manifold(LoadedMesh& loaded, Progress& progress, double from, double to);

}  // namespace strata::mesh
