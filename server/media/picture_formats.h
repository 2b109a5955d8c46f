#pragma once

#include <string>

#include "media/picture.h"

namespace strata {

// The internal readers of media/picture.h, with one source file per library.

// Returns the Error `invalid` with the name of the format and the reason.
tl::unexpected<Error> damaged_picture(PictureFormat format, const std::string& why);
// Returns the Error `invalid` if a side is 0 or longer than `largest_side`.
Result<PictureInfo> sized_picture(PictureFormat format, std::uint64_t width, std::uint64_t height,
                                  int largest_side);

Result<PictureInfo> inspect_tiff_picture(std::span<const std::uint8_t> bytes, int largest_side);
Result<Picture> decode_tiff_picture(std::span<const std::uint8_t> bytes, int largest_side);

Result<PictureInfo> inspect_webp(std::span<const std::uint8_t> bytes, int largest_side);
Result<Picture> decode_webp(std::span<const std::uint8_t> bytes, int largest_side);

// Functions for BMP and TGA.
bool is_bmp(std::span<const std::uint8_t> bytes);
bool is_tga(std::span<const std::uint8_t> bytes);
Result<PictureInfo> inspect_bitmap(PictureFormat format, std::span<const std::uint8_t> bytes,
                                   int largest_side);
Result<Picture> decode_bitmap(PictureFormat format, std::span<const std::uint8_t> bytes,
                              int largest_side);

}  // namespace strata
