#pragma once

#include <tiffio.h>

#include <cstdint>

#include "domain/layers/value_type.h"

// The tags that all TIFF files with values share.
namespace strata::query {

constexpr int kTiffTile = 256;  // side of a tile in pixels

// Returns the value of the tag SampleFormat for a type.
std::uint16_t sample_format(ValueType type);

// Describes an image in tiles that are compressed with deflate, with the first row at the top.
void set_tiles(TIFF* tiff, int width, int height);

}  // namespace strata::query
