#pragma once

#include <chrono>

#include "net/http/http_types.h"
#include "room/pictures.h"
#include "room/room.h"

namespace strata::net {

// The maximum time that a CPU spends on the samples of an image, or of each 2 million pixels of an
// image.
constexpr std::chrono::milliseconds kPictureSamplesTime{5000};

// Renders an image file: a JPEG of good quality, or a PNG. Encodes the file while the GPU renders.
Result<Response> picture_response(room::Room& room, const room::PictureRequest& shown,
                                  const Camera& camera, bool is_png);

}  // namespace strata::net
