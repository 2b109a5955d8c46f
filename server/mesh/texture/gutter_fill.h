#pragma once

#include "media/picture.h"

namespace strata::mesh {

// Gives a color to the pixels with alpha 0 and makes the image opaque. Therefore, filtering and
// coarser levels of a texture add no other colors. Up to `ring` pixels around filled pixels get the
// color of a nearest filled pixel. All other pixels get the mean of their surroundings, which
// becomes coarser with the distance. An image without any filled pixel becomes black.
void fill_gutter(Picture& picture, int ring);

}  // namespace strata::mesh
