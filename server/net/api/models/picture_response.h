#pragma once

#include <chrono>

#include "net/http/http_types.h"
#include "room/pictures.h"
#include "room/room.h"

namespace strata::net {

// A CPU takes this time at most for the samples of a picture, or of each 2 million pixels.
constexpr std::chrono::milliseconds kPictureSamplesTime{5000};

// Renders a picture to keep: JPEG of good quality, or PNG. Encodes while the GPU renders.
Result<Response> picture_response(room::Room& room, const room::PictureRequest& shown,
                                  const Camera& camera, bool is_png);

}  // namespace strata::net
