#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/problem.h"

namespace strata {

// Pictures as files: JPEG and PNG, told apart by their first bytes, never by a name. Thread-safe.

// RGBA8, row 0 at the top, sRGB; alpha is not multiplied in.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;
};

enum class PictureFormat { jpeg, png };
std::string_view media_type(PictureFormat format);  // "image/jpeg", "image/png"

// What the first bytes say; nothing: neither.
std::optional<PictureFormat> picture_format(std::span<const std::uint8_t> bytes);

struct PictureInfo {
  PictureFormat format = PictureFormat::png;
  int width = 0, height = 0;
};

constexpr int kLargestPictureSide = 16384;

// The size, from the header alone. 415: neither JPEG nor PNG; 422: damaged, or a side of more than `largest_side`.
Result<PictureInfo> inspect_picture(std::span<const std::uint8_t> bytes, int largest_side = kLargestPictureSide);

// Whole: all that libjpeg-turbo and libpng read (grey, palettes, 16 bits), as RGBA8. Refused as above, and where the
// data ends before the picture does.
Result<Picture> decode_picture(std::span<const std::uint8_t> bytes, int largest_side = kLargestPictureSide);

// The same, but a JPEG may come smaller, by halves, as long as its longer side keeps `side` pixels: it then takes little memory.
Result<Picture> decode_coarse(std::span<const std::uint8_t> bytes, int side);

struct JpegSettings {
  int quality = 80;         // 1…100
  bool full_color = false;  // 4:4:4 instead of 4:2:0
  bool operator==(const JpegSettings&) const = default;
};

// RGBA8 rows, top first → JPEG, which leaves alpha out. Throws where `rgba` is not width × height × 4 bytes.
std::vector<std::uint8_t> encode_jpeg(std::span<const std::uint8_t> rgba, int width, int height, JpegSettings settings);
std::vector<std::uint8_t> encode_png(std::span<const std::uint8_t> rgba, int width, int height);

}  // namespace strata
