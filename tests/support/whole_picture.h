#pragma once

#include "media/picture.h"
#include "room/pictures.h"

namespace strata::test {

// Returns one frame of a room as a single image.
inline Result<Picture> whole_picture(room::Pictures& pictures, const room::PictureRequest& request,
                                     const Camera& camera) {
  Picture whole;
  const room::PicturePart part{camera};
  STRATA_TRY(pictures.draw(
      request, {&part, 1}, [&](std::size_t, const room::PictureBand& band) -> Result<void> {
        whole.width = band.width;
        whole.height = band.height;
        whole.rgba.insert(whole.rgba.end(), band.rgba.begin(), band.rgba.end());
        return {};
      }));
  return whole;
}

}  // namespace strata::test
