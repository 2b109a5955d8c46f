#pragma once

#include "net/http_types.h"
#include "render/renderer.h"

namespace strata::net {

// A rendered picture, for keeps: JPEG of good quality, or PNG.
Response picture_response(const render::Frame& picture, bool is_png);

}  // namespace strata::net
