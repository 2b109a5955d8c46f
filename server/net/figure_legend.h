#pragma once

#include "net/figures.h"

namespace strata::net {

// Legends of the layers of a figure, the topmost first: those that a drawing shows, and of classes
// those that it shows. What an opaque layer above covers wholly, what is not in the drawing, and
// areas smaller than a dot of it are left out. Blocks.
Result<std::vector<figure::Legend>> legends_of(const RouteContext& context, const FigureWish& wish,
                                               const figure::Drawing& drawing);

}  // namespace strata::net
