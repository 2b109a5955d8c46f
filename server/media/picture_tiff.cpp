#include <algorithm>
#include <string>

#include "media/picture_formats.h"
#include "media/tiff_memory.h"

namespace strata {
namespace {

constexpr int kMaxSamples = 8;

tl::unexpected<Error> damaged(const TiffMemory& file) {
  return damaged_picture(PictureFormat::tiff,
                         file.complaint.empty() ? "it is damaged" : file.complaint);
}

// Returns whether a codec is common in photographs and scans. The others are rare, and each of them
// would increase the attack surface.
bool is_read_codec(int compression) {
  return is_lossless(compression) || compression == COMPRESSION_JPEG ||
         compression == COMPRESSION_CCITTRLE || compression == COMPRESSION_CCITTFAX3 ||
         compression == COMPRESSION_CCITTFAX4;
}

// Describes the first page. Fails if libtiff cannot convert it to RGBA.
Result<PictureInfo> describe(TIFF* tiff, int largest_side) {
  auto info = STRATA_TRY(
      sized_picture(PictureFormat::tiff, tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH),
                    tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH), largest_side));
  const int samples = tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL),
            bits = tiff_tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE),
            kind = tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT),
            compression = tiff_tag<std::uint16_t>(tiff, TIFFTAG_COMPRESSION);
  const auto unread = [](const std::string& what) {
    return damaged_picture(PictureFormat::tiff,
                           what + "; save it as RGB with 8 bits per sample, with or without alpha");
  };
  if (samples < 1 || samples > kMaxSamples)
    return unread("it has " + std::to_string(samples) + " samples per pixel");
  if (kind == SAMPLEFORMAT_IEEEFP) return unread("its samples are floating-point numbers");
  if (kind == SAMPLEFORMAT_INT) return unread("its samples are signed numbers");
  if (bits > 16) return unread("its samples have " + std::to_string(bits) + " bits");
  if (!is_read_codec(compression) ||
      !TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression)))
    return unread("its compression " + std::to_string(compression) + " is not supported");
  if (tiff_tag<std::uint16_t>(tiff, TIFFTAG_ORIENTATION) > ORIENTATION_BOTLEFT)
    return unread("it is stored rotated by 90° instead of upright");
  if (TIFFIsTiled(tiff)) {
    const auto width = tiff_tag<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH),
               height = tiff_tag<std::uint32_t>(tiff, TIFFTAG_TILELENGTH);
    const std::uint64_t pixel_bytes = static_cast<std::uint64_t>(samples) * 2 + 4;
    if (width == 0 || height == 0 || width > kMaxTiffTileBytes / pixel_bytes / height)
      return unread("its tiles have " + std::to_string(width) + " × " + std::to_string(height) +
                    " pixels");
  }
  if (char why[1024] = ""; !TIFFRGBAImageOK(tiff, why)) return unread(why);
  return info;
}

}  // namespace

Result<PictureInfo> inspect_tiff_picture(std::span<const std::uint8_t> bytes, int largest_side) {
  TiffMemory file{bytes, nullptr, 0, {}};
  const Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  return describe(tiff.get(), largest_side);
}

Result<Picture> decode_tiff_picture(std::span<const std::uint8_t> bytes, int largest_side) {
  TiffMemory file{bytes, nullptr, 0, {}};
  const Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  const auto info = STRATA_TRY(describe(tiff.get(), largest_side));
  const auto width = static_cast<std::uint32_t>(info.width),
             height = static_cast<std::uint32_t>(info.height);
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  Picture picture{info.width, info.height, std::vector<std::uint8_t>(pixels * 4)};
  // libtiff writes 32-bit words into the memory of the pixels. The words are then split into bytes
  // in place.
  auto* words = reinterpret_cast<std::uint32_t*>(picture.rgba.data());
  if (!TIFFReadRGBAImageOriented(tiff.get(), width, height, words, ORIENTATION_TOPLEFT, 1))
    return damaged(file);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint32_t packed = words[i], alpha = TIFFGetA(packed);
    const std::uint32_t colors[] = {TIFFGetR(packed), TIFFGetG(packed), TIFFGetB(packed)};
    std::uint8_t* rgba = &picture.rgba[4 * i];
    // libtiff multiplies the colors by alpha, which is reverted here.
    for (int c = 0; c < 3; ++c)
      rgba[c] = static_cast<std::uint8_t>(
          alpha == 0 ? 0 : std::min(255u, (colors[c] * 255 + alpha / 2) / alpha));
    rgba[3] = static_cast<std::uint8_t>(alpha);
  }
  return picture;
}

}  // namespace strata
