#pragma once

#include <cairo.h>

#include "figure/sheet.h"

namespace strata::figure {

// Draws the whole sheet except the drawing. The unit of the context must be a millimeter, and its
// origin the top left of the sheet.
void draw_groups(cairo_t* context, const Sheet& sheet);

}  // namespace strata::figure
