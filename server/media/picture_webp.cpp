#include <webp/decode.h>

#include <algorithm>

#include "media/picture_formats.h"

namespace strata {
namespace {

const char* meaning(VP8StatusCode status) {
  switch (status) {
    case VP8_STATUS_NOT_ENOUGH_DATA: return "it ends too early";
    case VP8_STATUS_OUT_OF_MEMORY: return "there is not enough memory";
    case VP8_STATUS_UNSUPPORTED_FEATURE: return "it uses a feature that libwebp does not support";
    default: return "it is damaged";
  }
}

}  // namespace

Result<PictureInfo> inspect_webp(std::span<const std::uint8_t> bytes, int largest_side) {
  WebPBitstreamFeatures features;
  if (const auto status = WebPGetFeatures(bytes.data(), bytes.size(), &features);
      status != VP8_STATUS_OK)
    return damaged_picture(PictureFormat::webp, meaning(status));
  if (features.has_animation)
    return damaged_picture(PictureFormat::webp,
                           "it is animated; save one of its pictures as a still picture");
  return sized_picture(PictureFormat::webp, static_cast<std::uint64_t>(std::max(features.width, 0)),
                       static_cast<std::uint64_t>(std::max(features.height, 0)), largest_side);
}

Result<Picture> decode_webp(std::span<const std::uint8_t> bytes, int largest_side) {
  const auto info = STRATA_TRY(inspect_webp(bytes, largest_side));
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config))
    return damaged_picture(PictureFormat::webp, "the version of libwebp does not match");
  Picture picture{info.width, info.height, {}};
  picture.rgba.resize(std::size_t(info.width) * std::size_t(info.height) * 4);
  config.output.colorspace = MODE_RGBA;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {picture.rgba.data(), 4 * info.width, picture.rgba.size()};
  if (const auto status = WebPDecode(bytes.data(), bytes.size(), &config); status != VP8_STATUS_OK)
    return damaged_picture(PictureFormat::webp, meaning(status));
  return picture;
}

}  // namespace strata
