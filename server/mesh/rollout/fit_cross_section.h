#pragma once

#include "mesh/rollout/rollout_sheet.h"

namespace strata::mesh {

// Fits the cross section of a general cylinder, for each half of a degree, from the distances of
// the surface from the axis at 128 heights. The model is distance = radius(direction) ·
// scale(height), with a median scale of 1 (robust_section.h). So a pot has the section of its
// median radius, and handles and noise have almost no effect. The section is as smooth as the
// errors of the distances permit, and keeps corners (smooth_section.h). Only surface that a rollout
// can show counts. The section is interpolated between its parts. `fitted` is the fit and the sheet
// of a circular cylinder around the same axis; it gets the section, the RMS distance of the surface
// from it, and the new bounds of the sheet. `tree` is of `geometry`. Returns an `invalid` error on
// the field `axis` if there is no surface. Without an axis of the caller, also if the heights have
// no common section: the shape deviates by more than 10 % of the radius, apart from the scale, or
// the surface by more than a third. Checks the current question. Casts about 92 000 rays, which
// takes less than a second on two cores.
Result<void> fit_cross_section(const SearchTree& tree, const Geometry& geometry,
                               const FitRequest& request, FittedSheet& fitted);

}  // namespace strata::mesh
