#pragma once

#include "domain/layers/palette.h"

namespace strata {

// Returns the contrast of two opaque colors, from 1 to 21, as WCAG 2.2 defines it (relative
// luminance in sRGB).
double contrast(const Rgba& a, const Rgba& b);

}  // namespace strata
