#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {

// Pictures as files, told apart by their bytes, never by a name. Thread-safe.
//
// JPEG: also grey and CMYK (whose inks become colours without their profile). PNG: all. TIFF: the
// first page; grey, colour tables, RGB, CMYK and YCbCr of up to 16 bits, in strips or tiles,
// losslessly packed, as JPEG or as fax. WebP: still pictures. BMP: without run lengths. TGA: all.
// Of 16 bits the upper 8 are kept.

// RGBA8, row 0 at the top, sRGB; alpha is not multiplied in.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

enum class PictureFormat { jpeg, png, tiff, webp, bmp, tga };
std::string_view media_type(PictureFormat format);  // "image/jpeg", "image/png", …

// What the first bytes say; nothing: none of them. A TGA has no mark: bytes are one where all
// fields of its header make sense.
std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes);

// SurfaceImages are JPEG or PNG, which every browser shows. Others are stored as the PNG of their
// pixels.
inline bool is_surface_image_format(PictureFormat format) {
  return format == PictureFormat::jpeg || format == PictureFormat::png;
}

struct PictureInfo {
  PictureFormat format = PictureFormat::png;
  int width = 0, height = 0;
};

constexpr int kMaxPictureSide = 16384;

// The size, from the header alone. unsupported: none of the formats, by its name where it is a
// known one; invalid: damaged, or a side of more than `largest_side`.
Result<PictureInfo> inspect_picture(std::span<const std::uint8_t> bytes,
                                    int largest_side = kMaxPictureSide);

// Whole, as RGBA8. Refused as above, where the data ends before the picture does, and where it is
// of a kind that is not read (invalid, which names it). Sizes are checked before anything is
// allocated; takes at most twice the pixels' memory.
Result<Picture> decode_picture(std::span<const std::uint8_t> bytes,
                               int largest_side = kMaxPictureSide);

// The same, but a JPEG may come smaller, by halves, as long as its longer side keeps `side` pixels:
// it then takes little memory.
Result<Picture> decode_coarse(std::span<const std::uint8_t> bytes, int side);

struct JpegSettings {
  int quality = 80;         // 1…100
  bool full_color = false;  // 4:4:4 instead of 4:2:0
  bool operator==(const JpegSettings&) const = default;
};

// RGBA8 rows, top first → JPEG, which leaves alpha out. Throws where `rgba` is not width × height ×
// 4 bytes.
std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height,
                                      JpegSettings settings);
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace strata
