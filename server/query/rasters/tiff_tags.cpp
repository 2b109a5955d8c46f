#include "query/rasters/tiff_tags.h"

namespace strata::query {

std::uint16_t sample_format(ValueType type) {
  if (is_float(type)) return SAMPLEFORMAT_IEEEFP;
  return lowest_value(type) < 0 ? SAMPLEFORMAT_INT : SAMPLEFORMAT_UINT;
}

void set_tiles(TIFF* tiff, int width, int height) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(width));
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height));
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kTiffTile);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, kTiffTile);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_ZIPQUALITY, 3);
}

}  // namespace strata::query
