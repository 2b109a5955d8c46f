#pragma once

#include "core/progress.h"
#include "mesh/surface/geometry.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::jobs {

// Puts a geometry into a new model, with the derived data: its stored form and that of its coarser
// copies, the light at its vertices, counts, box, area and open edges. Refused only when canceled.
Result<void> put_geometry(mesh::Geometry geometry, Progress& progress, store::NewModel& fresh);

}  // namespace strata::jobs
