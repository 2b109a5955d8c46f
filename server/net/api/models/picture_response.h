#pragma once

#include "net/http/http_types.h"
#include "room/pictures.h"
#include "room/room.h"

namespace strata::net {

// A rendered picture, for keeps: JPEG of good quality, or PNG. Encoded while it is drawn.
Result<Response> picture_response(room::Room& room, const room::PictureRequest& shown,
                                  const Camera& camera, bool is_png);

}  // namespace strata::net
