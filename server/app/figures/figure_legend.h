#pragma once

#include "app/figures/figures.h"

namespace strata::app {

// Legends of the layers of a figure, the topmost first: those that a drawing shows, and of classes
// those that it shows. What an opaque layer above covers wholly, what is not in the drawing, and
// areas smaller than a dot of it are left out. Blocks.
Result<std::vector<figure::Legend>> legends_of(store::Store& store, const FigureRequest& request,
                                               const figure::Drawing& drawing);

}  // namespace strata::app
