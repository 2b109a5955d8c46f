#pragma once

#include "mesh/io/load.h"

namespace strata::mesh {

// Orients the triangles consistently with their neighbors and cuts the surface where it is not
// manifold. `loaded.mesh` must be welded and have its indices in range. No triangle may repeat a
// corner or another triangle. The changes are noted.
//
// - At an edge with more than two triangles, the triangles are joined in pairs that agree in
//   direction. Pairs without loose fins come first, and flatter pairs come before less flat pairs.
//   Slivers without area on an edge of two other triangles are dropped beforehand.
// - Each piece of the surface gets the orientation of most of its triangles. Closed pieces are
// turned
//   outward, as determined by their signed volume, unless they are hollows. A hollow is inside the
//   box of a larger closed piece, and the file orients it inward.
// - A piece that cannot be oriented consistently, such as a Möbius strip, is cut.
// - Finally, a vertex with triangles in several fans is copied for each fan.
//
// Fails when cancelled. Progress is reported from `from` to `to`.
Result<void> make_manifold(LoadedMesh& loaded, Progress& progress, double from, double to);

}  // namespace strata::mesh
