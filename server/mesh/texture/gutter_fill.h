#pragma once

#include "media/picture.h"

namespace strata::mesh {

// Gives the pixels whose alpha is 0 a colour and makes the picture opaque, so that neither
// filtering nor the coarser levels of a texture bleed: up to `ring` pixels around what is filled
// take the colour of a nearest filled pixel, and what is left the mean of what is around it,
// coarser the farther away. A picture without any filled pixel becomes black.
void fill_gutter(Picture& picture, int ring);

}  // namespace strata::mesh
