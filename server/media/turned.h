#pragma once

#include "media/picture.h"

namespace strata {

// Applies an Exif orientation: 1 is upright, 3 is upside down, 6 needs a turn to the right, 8 a
// turn to the left. 2, 4, 5 and 7 are mirrored.
Picture turned(Picture picture, int orientation);

}  // namespace strata
