#pragma once

#include "media/picture.h"

namespace strata::mesh {

// Gives the pixels whose alpha is 0 a color and makes the picture opaque, so that neither filtering
// nor the coarser levels of a texture bleed. Up to `ring` pixels around filled ones get the color
// of a nearest filled pixel; the rest gets the mean of its surroundings, coarser with the distance.
// A picture without any filled pixel becomes black.
void fill_gutter(Picture& picture, int ring);

}  // namespace strata::mesh
