#pragma once

#include "app/photographs/pinhole.h"
#include "media/picture.h"

namespace strata::app {

// Returns the picture that the pinhole sees, with `width` pixels and as many rows as its sides
// require. Interpolates between the pixels of the original, which may also be a smaller copy of the
// photograph. Pixels that the photograph does not have are black. Checks the current question.
Picture undistorted(const Picture& original, const photo::Camera& camera, const Pinhole& pinhole,
                    int width);

// Returns the length of the longer side of the original that `undistorted` needs for this width:
// a smaller copy would lose detail, and a larger one only costs time and causes patterns.
int side_for(const photo::Camera& camera, const Pinhole& pinhole, int width);

// Halves the picture while its longer side has at least twice this length.
Picture halved_to(Picture picture, int side);

}  // namespace strata::app
