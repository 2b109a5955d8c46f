#pragma once

#include "mesh/rollout/rollout_rays.h"
#include "mesh/rollout/sheet_area.h"
#include "query/conditions/texel_selection.h"

namespace strata::query {

// Selects the texels that a rollout shows inside an area of its sheet, in model units (the oracle
// of its unit test is mesh::trace_rollout). `origin` is the origin of the geometry. Where the sheet
// continues past the cut (RolloutSheet::beyond_cut), the area can extend past it. Needs memory only
// for the result. Checks the current question.
TexelSelection select_unrolled(const mesh::SurfaceMap& map, const mesh::RolloutRays& rays,
                               const glm::dvec3& origin, const mesh::SheetArea& area, int threads);

}  // namespace strata::query
