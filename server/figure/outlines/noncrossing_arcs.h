#pragma once

#include "figure/outlines/smooth_arc.h"

namespace strata::figure {

// Smooths all borders, so that they divide the grid in the same way as before: they neither cross
// nor touch, except at their nodes, the order of borders around each node is kept, and no border
// jumps over a face. Where borders are too close to each other for this, they get less of the
// tolerance, and finally keep their form. The frame of the grid keeps its form. Returns one line
// for each border, or the error `cancelled`.
Result<std::vector<SmoothArc>> noncrossing_arcs(const LabelFaces& faces, const BorderGraph& graph,
                                                double tolerance, const Progress& progress);

}  // namespace strata::figure
