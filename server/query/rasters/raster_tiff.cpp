#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <string>

#include "media/tiff_memory.h"
#include "query/maps/geo_tags.h"
#include "query/rasters/raster.h"
#include "query/rasters/raster_rows.h"
#include "query/rasters/raster_samples.h"
#include "query/rasters/tiff_tags.h"

namespace strata::query {
namespace {

// Integers have no value for "not painted", because any integer may be painted. Floats use NaN,
// which is never painted.
void describe_values(TIFF* tiff, const Layer& layer) {
  const std::uint16_t not_alpha = EXTRASAMPLE_UNSPECIFIED;
  set_tiles(tiff, layer.resolution, layer.resolution);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 2);
  TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &not_alpha);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * bytes_per_texel(layer.type));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, sample_format(layer.type));
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, "Strata");
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION,
               ("Layer " + layer.name + ": value, then valid (1 or 0)").c_str());
  if (is_float(layer.type)) set_nodata(tiff, "nan");
}

// Sets the tags of an internal mask as in GDAL.
void describe_mask(TIFF* tiff, const Layer& layer) {
  set_tiles(tiff, layer.resolution, layer.resolution);
  TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, FILETYPE_MASK);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 1);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MASK);
}

// Writes the texels of a layer as the tiles of a TIFF.
class TiffTiles {
 public:
  TiffTiles(const Layer& layer, const TileMap& tiles)
      : side_(layer.resolution),
        width_(bytes_per_texel(layer.type)),
        one_(*encode_value(layer.type, 1)),
        nothing_(!is_float(layer.type) ? 0
                 : layer.type == ValueType::f16
                     ? 0x7e00u
                     : std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN())),
        rows_(layer, tiles),
        bits_(static_cast<std::size_t>(side_) * kTiffTile),
        valid_(bits_.size()) {}

  // Writes the value and the valid flag of each texel, interleaved.
  bool write_values(TIFF* tiff) {
    return write(tiff, kTiffTile * 2 * static_cast<std::size_t>(width_),
                 [&](std::uint8_t* row, int x, std::size_t from) {
                   std::uint8_t* to =
                       row + static_cast<std::size_t>(x) * 2 * static_cast<std::size_t>(width_);
                   std::memcpy(to, valid_[from] ? &bits_[from] : &nothing_,
                               static_cast<std::size_t>(width_));
                   if (valid_[from])
                     std::memcpy(to + width_, &one_, static_cast<std::size_t>(width_));
                 });
  }
  // Writes one bit for each texel.
  bool write_mask(TIFF* tiff) {
    return write(tiff, kTiffTile / 8, [&](std::uint8_t* row, int x, std::size_t from) {
      if (valid_[from]) row[x / 8] |= static_cast<std::uint8_t>(0x80u >> x % 8);
    });
  }

 private:
  template <class Put>
  bool write(TIFF* tiff, std::size_t row_bytes, Put put) {
    std::vector<std::uint8_t> tile(row_bytes * kTiffTile);
    for (int top = 0; top < side_; top += kTiffTile) {
      const int height = std::min(kTiffTile, side_ - top);
      for (int y = 0; y < height; ++y) {
        const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(side_);
        rows_.read(top + y, std::span(bits_).subspan(at, static_cast<std::size_t>(side_)),
                   std::span(valid_).subspan(at, static_cast<std::size_t>(side_)));
      }
      for (int left = 0; left < side_; left += kTiffTile) {
        std::ranges::fill(tile, std::uint8_t{0});
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < std::min(kTiffTile, side_ - left); ++x)
            put(tile.data() + static_cast<std::size_t>(y) * row_bytes, x,
                static_cast<std::size_t>(y) * static_cast<std::size_t>(side_) +
                    static_cast<std::size_t>(left + x));
        if (TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                          static_cast<std::uint32_t>(top), 0, 0) < 0)
          return false;
      }
    }
    return TIFFWriteDirectory(tiff) == 1;
  }

  const int side_, width_;
  const std::uint32_t one_, nothing_;  // bits of a set valid flag, and of a missing value
  const TileRows rows_;
  std::vector<std::uint32_t> bits_;
  std::vector<std::uint8_t> valid_;
};

}  // namespace

Result<std::vector<std::uint8_t>> encode_tiff(const Layer& layer, const TileMap& tiles) {
  std::vector<std::uint8_t> out;
  TiffMemory file{{}, &out, 0, {}};
  auto failed = [&] {
    return fail(ErrorCode::internal, "TIFF not written", "libtiff: " + file.complaint);
  };
  Tiff tiff = open_tiff(file, "wm");
  if (!tiff) return failed();
  TiffTiles written(layer, tiles);
  describe_values(tiff.get(), layer);
  if (!written.write_values(tiff.get())) return failed();
  describe_mask(tiff.get(), layer);
  if (!written.write_mask(tiff.get())) return failed();
  tiff.reset();
  if (!file.complaint.empty()) return failed();
  return out;
}

}  // namespace strata::query
