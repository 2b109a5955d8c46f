#pragma once

#include "app/figures/figures.h"

namespace strata::app {

// Returns the legends of the layers in a drawing, topmost first. A legend contains only classes
// that the drawing shows. Leaves out layers that opaque layers cover completely, content outside
// the drawing, and areas smaller than a dot of the drawing. Blocks.
Result<std::vector<figure::Legend>> legends_of(store::Store& store, const FigureRequest& request,
                                               const figure::Drawing& drawing);

}  // namespace strata::app
