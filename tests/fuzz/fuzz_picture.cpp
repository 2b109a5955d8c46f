// Fuzzes images of surface images, orthophotos and brush shapes. A decoded image must have the size
// in its header. A shape must not change if it is sent again as the image that the page shows.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "media/picture.h"
#include "media/shape_texture.h"

namespace {

constexpr int kMaxSide = 512;  // larger images only take longer

void demand(bool holds) {
  if (!holds) std::abort();
}

void check_shape(const strata::Picture& picture) {
  for (const auto part :
       {strata::ShapePart::opaque, strata::ShapePart::light, strata::ShapePart::dark}) {
    const auto bits = strata::shape_of(picture, part);
    if (!bits) continue;
    const strata::ShapeTexture texture(*bits);
    demand(texture.inner_radius() >= 0 && texture.inner_radius() <= 1);
    for (int i = 0; i < strata::kShapeSide * strata::kShapeSide; i += 97)
      demand((texture.distances()[static_cast<std::size_t>(i)] == 0) ==
             texture.is_set(i % strata::kShapeSide, i / strata::kShapeSide));
    const auto again = strata::shape_of(strata::picture_of(*bits), strata::ShapePart::opaque);
    demand(again.has_value() && *again == *bits);
    return;  // one shape is enough: its preparation takes longer than all other steps
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const auto info = strata::inspect_picture(bytes, kMaxSide);
  const auto picture = strata::decode_picture(bytes, kMaxSide);
  if (!picture) return 0;
  demand(info.has_value() && info->width == picture->width && info->height == picture->height);
  demand(picture->rgba.size() ==
         4 * static_cast<std::size_t>(picture->width) * static_cast<std::size_t>(picture->height));
  check_shape(*picture);
  return 0;
}
