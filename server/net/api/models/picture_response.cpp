#include "net/api/models/picture_response.h"

#include "media/picture.h"
#include "room/pictures.h"

namespace strata::net {

Result<Response> picture_response(room::Room& room, const room::PictureRequest& shown,
                                  const Camera& camera, bool is_png) {
  constexpr int kJpegQuality = 90;  // higher than for streamed frames
  const PictureFormat format = is_png ? PictureFormat::png : PictureFormat::jpeg;
  auto file = STRATA_TRY(room.pictures().draw_file(shown, camera, format, {kJpegQuality, true}));
  return bytes_response(std::move(file), std::string(media_type(format)));
}

}  // namespace strata::net
