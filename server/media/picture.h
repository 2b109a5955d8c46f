#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// Reads and writes image files. The bytes determine the format, and the name has no effect.
// Thread-safe.
//
// Supported files:
// - JPEG: also gray and CMYK. CMYK is converted without its color profile.
// - PNG: all variants.
// - TIFF: the first page; gray, color tables, RGB, CMYK and YCbCr with up to 16 bits, in strips or
//   tiles, with lossless, JPEG or fax compression.
// - WebP: still images.
// - BMP: without run-length compression.
// - TGA: all variants.
// Only the upper 8 bits of 16-bit values are used.

// RGBA8 in sRGB, top row first. Alpha is not premultiplied.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

enum class PictureFormat { jpeg, png, tiff, webp, bmp, tga };
std::string_view media_type(PictureFormat format);  // "image/jpeg", "image/png", …

// Returns the format, according to the first bytes, or nothing for an unknown format. TGA has no
// signature. A TGA is detected if all fields of its header are plausible.
std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes);

// Surface images are stored as JPEG or PNG, because all browsers show these formats. Other formats
// are converted to PNG.
inline bool is_surface_image_format(PictureFormat format) {
  return format == PictureFormat::jpeg || format == PictureFormat::png;
}

struct PictureInfo {
  PictureFormat format = PictureFormat::png;
  int width = 0, height = 0;
};

constexpr int kMaxPictureSide = 16384;

// Returns the format and the size, from the header alone. Errors: `unsupported` for another format,
// with its name if it is known; `invalid` for a damaged header, or a side longer than
// `largest_side`.
Result<PictureInfo> inspect_picture(std::span<const std::uint8_t> bytes,
                                    int largest_side = kMaxPictureSide);

// Decodes the whole image as RGBA8. In addition to the Errors above, returns `invalid` for
// truncated data and for unsupported variants, with the name of the variant. Checks the size before
// any allocation. Needs at most twice the memory of the pixels.
Result<Picture> decode_picture(std::span<const std::uint8_t> bytes,
                               int largest_side = kMaxPictureSide);

// Like decode_picture, but may halve a JPEG repeatedly to save memory. Its longer side has at least
// `side` pixels.
Result<Picture> decode_coarse(std::span<const std::uint8_t> bytes, int side);

struct JpegSettings {
  int quality = 80;         // 1…100
  bool full_color = false;  // 4:4:4 instead of 4:2:0
  bool operator==(const JpegSettings&) const = default;
};

// Encode RGBA8 pixels, top row first. JPEG has no alpha. Throw if `rgba` does not have width ×
// height × 4 bytes.
std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height,
                                      JpegSettings settings);
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace strata
