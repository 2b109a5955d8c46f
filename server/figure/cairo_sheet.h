#pragma once

#include <cairo.h>

#include "figure/sheet.h"

namespace strata::figure {

// Draws everything except the drawing. A unit of the context is a millimeter, its origin the
// sheet's top left.
void draw_groups(cairo_t* context, const Sheet& sheet);

}  // namespace strata::figure
