#pragma once

#include "core/progress.h"
#include "mesh/surface/geometry.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::jobs {

// Puts a geometry into a new model, with the derived data: the encoded geometry and its encoded
// coarser copies, the light at its vertices, counts, box, area and open edges. Fails only if it is
// canceled.
Result<void> put_geometry(mesh::Geometry geometry, Progress& progress, store::NewModel& fresh);

}  // namespace strata::jobs
