#include "net/picture_response.h"

#include "core/picture.h"

namespace strata::net {

Response picture_response(const render::Frame& picture, bool is_png) {
  constexpr int kJpegQuality = 90;  // one picture, not a frame of many
  if (is_png) return bytes_response(encode_png(picture.pixels, picture.width, picture.height), "image/png");
  return bytes_response(encode_jpeg(picture.pixels, picture.width, picture.height, {kJpegQuality, true}), "image/jpeg");
}

}  // namespace strata::net
