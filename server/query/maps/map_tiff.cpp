#include "query/maps/map_tiff.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "media/tiff_memory.h"
#include "query/maps/geo_tags.h"

namespace strata::query {
namespace {

tl::unexpected<Error> refuse(const std::string& what) {
  return fail(ErrorCode::invalid, "TIFF not accepted", what, "body");
}

tl::unexpected<Error> damaged(const TiffMemory& file) {
  return refuse("The TIFF cannot be read: " +
                (file.complaint.empty() ? std::string("damaged") : file.complaint) + ".");
}

std::optional<ValueType> sample_type(int bits, int format) {
  if (format == SAMPLEFORMAT_IEEEFP) {
    if (bits == 16) return ValueType::f16;
    if (bits == 32 || bits == 64) return ValueType::f32;
    return std::nullopt;
  }
  const bool is_signed = format == SAMPLEFORMAT_INT;
  if (!is_signed && format != SAMPLEFORMAT_UINT) return std::nullopt;
  switch (bits) {
    case 8: return is_signed ? ValueType::i8 : ValueType::u8;
    case 16: return is_signed ? ValueType::i16 : ValueType::u16;
    case 32: return is_signed ? ValueType::i32 : ValueType::u32;
    default: return std::nullopt;
  }
}

// Returns true for the compressions of scanned maps and photographs.
bool is_picture_codec(int compression) {
  return is_lossless(compression) || compression == COMPRESSION_JPEG ||
         compression == COMPRESSION_CCITTRLE || compression == COMPRESSION_CCITTFAX3 ||
         compression == COMPRESSION_CCITTFAX4;
}

// Returns true if libtiff can convert the whole image to RGBA.
bool can_be_rgba(TIFF* tiff, int bits, int format) {
  char why[1024];
  return bits <= 16 && format != SAMPLEFORMAT_IEEEFP && format != SAMPLEFORMAT_INT &&
         TIFFRGBAImageOK(tiff, why);
}

bool is_nodata(const MapTiff& info, double value) {
  if (!info.nodata) return false;
  return info.type == ValueType::f32 ? static_cast<float>(value) == static_cast<float>(*info.nodata)
                                     : value == *info.nodata;
}

// Extracts one band from rows of samples.
class BandReader {
 public:
  BandReader(const MapTiff& info, int band, TIFF* tiff)
      : info_(info),
        width_(tiff_tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE) / 8u),
        is_separate_(tiff_tag<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE),
        band_(band - 1) {
    raster_.width = info.width;
    raster_.height = info.height;
    raster_.type = info.type;
    const auto pixels =
        static_cast<std::size_t>(info.width) * static_cast<std::size_t>(info.height);
    raster_.bits.resize(pixels);
    raster_.valid.resize(pixels);
  }

  std::uint16_t plane() const {
    return is_separate_ ? static_cast<std::uint16_t>(band_) : std::uint16_t{0};
  }
  std::size_t pixel_bytes() const {
    return is_separate_ ? width_ : width_ * static_cast<std::size_t>(info_.bands);
  }

  // Reads `count` pixels from `samples`; the first pixel is (x, row).
  void put(const std::uint8_t* samples, std::uint32_t x, std::uint32_t row, std::uint32_t count) {
    const std::uint8_t* from =
        samples + (is_separate_ ? 0 : width_ * static_cast<std::size_t>(band_));
    std::size_t to = static_cast<std::size_t>(row) * static_cast<std::size_t>(info_.width) + x;
    for (std::uint32_t i = 0; i < count; ++i, from += pixel_bytes(), ++to) {
      std::uint32_t bits = 0;
      if (width_ == 8) {
        double wide = 0;
        std::memcpy(&wide, from, sizeof wide);
        const auto narrow = static_cast<float>(wide);
        std::memcpy(&bits, &narrow, sizeof narrow);
      } else {
        std::memcpy(&bits, from, width_);
      }
      const double value = decode_value(info_.type, bits);
      if (!std::isfinite(value) || is_nodata(info_, value)) continue;
      raster_.bits[to] = *encode_value(info_.type, value);  // encoded as in layers
      raster_.valid[to] = 1;
    }
  }

  BandRaster take() { return std::move(raster_); }

 private:
  const MapTiff& info_;
  const std::size_t width_;  // bytes of a sample
  const bool is_separate_;
  const int band_;  // counted from 0
  BandRaster raster_;
};

Result<void> read_tiles(TIFF* tiff, const TiffMemory& file, const MapTiff& info, BandReader& band) {
  const auto tile_width = tiff_tag<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH),
             tile_height = tiff_tag<std::uint32_t>(tiff, TIFFTAG_TILELENGTH);
  const std::uint64_t row_bytes = tile_width * band.pixel_bytes();
  if (tile_width == 0 || tile_height == 0 || row_bytes > kMaxTiffTileBytes / tile_height)
    return refuse("The TIFF's tiles are " + std::to_string(tile_width) + " × " +
                  std::to_string(tile_height) + ". Save it with tiles of 256 × 256.");
  std::vector<std::uint8_t> tile(row_bytes * tile_height);
  if (TIFFTileSize64(tiff) != tile.size()) return damaged(file);
  const auto width = static_cast<std::uint32_t>(info.width),
             height = static_cast<std::uint32_t>(info.height);
  for (std::uint32_t top = 0; top < height; top += tile_height)
    for (std::uint32_t left = 0; left < width; left += tile_width) {
      if (TIFFReadTile(tiff, tile.data(), left, top, 0, band.plane()) !=
          static_cast<tmsize_t>(tile.size()))
        return damaged(file);
      for (std::uint32_t y = 0; y < std::min(tile_height, height - top); ++y)
        band.put(tile.data() + y * row_bytes, left, top + y, std::min(tile_width, width - left));
    }
  return {};
}

Result<void> read_rows(TIFF* tiff, const TiffMemory& file, const MapTiff& info, BandReader& band) {
  std::vector<std::uint8_t> row(static_cast<std::size_t>(info.width) * band.pixel_bytes());
  if (TIFFScanlineSize64(tiff) != row.size()) return damaged(file);
  for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(info.height); ++y) {
    if (TIFFReadScanline(tiff, row.data(), y, band.plane()) != 1) return damaged(file);
    band.put(row.data(), 0, y, static_cast<std::uint32_t>(info.width));
  }
  return {};
}

Result<MapTiff> describe(TIFF* tiff, int largest_side) {
  MapTiff info;
  const auto width = tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH),
             height = tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH);
  if (width < 1 || height < 1 || std::max(width, height) > static_cast<std::uint32_t>(largest_side))
    return refuse("The TIFF has " + std::to_string(width) + " × " + std::to_string(height) +
                  " pixels. Each side must be 1 to " + std::to_string(largest_side) +
                  " pixels long.");
  info.width = static_cast<int>(width);
  info.height = static_cast<int>(height);
  info.bands = tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL);
  if (info.bands < 1) return refuse("The TIFF has no bands.");
  const int bits = tiff_tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE),
            format = tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT);
  const int compression = tiff_tag<std::uint16_t>(tiff, TIFFTAG_COMPRESSION);
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  const int orientation = tiff_tag<std::uint16_t>(tiff, TIFFTAG_ORIENTATION);
  if (orientation != ORIENTATION_TOPLEFT)
    return refuse("The TIFF is stored turned or mirrored (orientation " +
                  std::to_string(orientation) +
                  "), so its position is not clear. Save it upright.");
  const auto type = sample_type(bits, format);
  const bool is_readable = is_picture_codec(compression) &&
                           TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression));
  info.type = type.value_or(ValueType::u8);
  info.has_numbers = type && is_readable && is_lossless(compression);
  info.has_colors = is_readable && can_be_rgba(tiff, bits, format);
  info.is_rgb =
      info.has_colors && (photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_YCBCR);
  if (!info.has_numbers && !info.has_colors)
    return refuse("The TIFF has " + std::to_string(info.bands) + " bands of " +
                  std::to_string(bits) + "-bit samples with compression " +
                  std::to_string(compression) +
                  ". Save it with 8, 16 or 32 bits per band and with deflate, LZW, zstd or no "
                  "compression.");
  STRATA_TRY(read_geo_tags(tiff, info));
  return info;
}

}  // namespace

bool is_tiff(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 4) return false;
  const bool little =
      bytes[0] == 'I' && bytes[1] == 'I' && (bytes[2] == 42 || bytes[2] == 43) && bytes[3] == 0;
  const bool big =
      bytes[0] == 'M' && bytes[1] == 'M' && bytes[2] == 0 && (bytes[3] == 42 || bytes[3] == 43);
  return little || big;
}

Result<MapTiff> inspect_tiff(std::span<const std::uint8_t> bytes, int largest_side) {
  TiffMemory file{bytes, nullptr, 0, {}};
  const Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  return describe(tiff.get(), largest_side);
}

Result<Picture> decode_tiff_picture(std::span<const std::uint8_t> bytes, const MapTiff& info) {
  TiffMemory file{bytes, nullptr, 0, {}};
  const Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  if (!info.has_colors)
    return refuse("The TIFF contains numbers instead of colors. Choose one of its bands.");
  const auto width = static_cast<std::uint32_t>(info.width),
             height = static_cast<std::uint32_t>(info.height);
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  Picture picture{info.width, info.height, std::vector<std::uint8_t>(pixels * 4)};
  std::vector<std::uint32_t> raster(pixels);
  if (!TIFFReadRGBAImageOriented(tiff.get(), width, height, raster.data(), ORIENTATION_TOPLEFT, 1))
    return damaged(file);
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint32_t packed = raster[i], alpha = TIFFGetA(packed);
    std::uint8_t* rgba = &picture.rgba[4 * i];
    const std::uint32_t colors[] = {TIFFGetR(packed), TIFFGetG(packed), TIFFGetB(packed)};
    bool is_empty = info.nodata.has_value();
    for (int c = 0; c < 3; ++c) {
      // libtiff returns colors multiplied by alpha.
      rgba[c] = static_cast<std::uint8_t>(
          alpha == 0 ? 0 : std::min(255u, (colors[c] * 255 + alpha / 2) / alpha));
      is_empty = is_empty && rgba[c] == *info.nodata;
    }
    rgba[3] = is_empty ? 0 : static_cast<std::uint8_t>(alpha);
  }
  return picture;
}

Result<BandRaster> decode_tiff_band(std::span<const std::uint8_t> bytes, const MapTiff& info,
                                    int band) {
  if (band < 1 || band > info.bands)
    return fail(ErrorCode::invalid, "Band not found",
                "The TIFF has the bands 1 to " + std::to_string(info.bands) + ".", "band");
  if (!info.has_numbers)
    return fail(ErrorCode::invalid, "No usable numbers",
                "The bands of the TIFF must contain numbers of 8, 16 or 32 bits with lossless "
                "compression. Save the TIFF again in this form.",
                "band");
  TiffMemory file{bytes, nullptr, 0, {}};
  const Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  BandReader reader(info, band, tiff.get());
  STRATA_TRY(TIFFIsTiled(tiff.get()) ? read_tiles(tiff.get(), file, info, reader)
                                     : read_rows(tiff.get(), file, info, reader));
  return reader.take();
}

}  // namespace strata::query
