#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// Pictures as files, identified by their bytes, never by a name. Thread-safe.
//
// JPEG: also gray and CMYK (whose inks are converted without their profile). PNG: all. TIFF: the
// first page; gray, color tables, RGB, CMYK and YCbCr of up to 16 bits, in strips or tiles, with
// lossless, JPEG or fax compression. WebP: still pictures. BMP: without run lengths. TGA: all.
// 16-bit values keep their upper 8 bits.

// RGBA8, row 0 at the top, sRGB; alpha is not premultiplied.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

enum class PictureFormat { jpeg, png, tiff, webp, bmp, tga };
std::string_view media_type(PictureFormat format);  // "image/jpeg", "image/png", …

// Returns the format by the first bytes; nothing: no known format. A TGA has no signature: it is
// recognized if all fields of its header are plausible.
std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes);

// Surface images are JPEG or PNG, which every browser shows. Other formats are converted to PNG.
inline bool is_surface_image_format(PictureFormat format) {
  return format == PictureFormat::jpeg || format == PictureFormat::png;
}

struct PictureInfo {
  PictureFormat format = PictureFormat::png;
  int width = 0, height = 0;
};

constexpr int kMaxPictureSide = 16384;

// Returns the size, from the header alone. unsupported: not one of the formats, with the name of a
// known other format; invalid: damaged, or a side of more than `largest_side`.
Result<PictureInfo> inspect_picture(std::span<const std::uint8_t> bytes,
                                    int largest_side = kMaxPictureSide);

// Decodes the whole picture as RGBA8. Refuses as above, and (invalid) truncated data and
// unsupported variants, which the message names. Checks sizes before any allocation; takes at most
// twice the pixels' memory.
Result<Picture> decode_picture(std::span<const std::uint8_t> bytes,
                               int largest_side = kMaxPictureSide);

// The same, but a JPEG may be reduced by halves as long as its longer side has at least `side`
// pixels: it then takes little memory.
Result<Picture> decode_coarse(std::span<const std::uint8_t> bytes, int side);

struct JpegSettings {
  int quality = 80;         // 1…100
  bool full_color = false;  // 4:4:4 instead of 4:2:0
  bool operator==(const JpegSettings&) const = default;
};

// Encodes RGBA8 rows, top first, as JPEG, without alpha. Throws if `rgba` is not width × height × 4
// bytes.
std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height,
                                      JpegSettings settings);
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace strata
