#include <algorithm>
#include <string>

#include "media/tiff_memory.h"
#include "query/maps/geo_tags.h"
#include "query/rasters/raster.h"
#include "query/rasters/raster_rows.h"
#include "query/rasters/raster_samples.h"

namespace strata::query {
namespace {

constexpr int kMaxDirectories = 64;  // limit for the search for a mask

tl::unexpected<Error> damaged(const TiffMemory& file) {
  return refuse_raster("The TIFF cannot be read: " +
                       (file.complaint.empty() ? std::string("damaged") : file.complaint) + ".");
}

std::optional<SampleForm> sample_form(int bits, int format) {
  if (bits != 8 && bits != 16 && bits != 32 && bits != 64) return std::nullopt;
  const int bytes = bits / 8;
  // libtiff converts samples to the byte order of the machine.
  if (format == SAMPLEFORMAT_UINT) return SampleForm{SampleForm::Kind::unsigned_whole, bytes};
  if (format == SAMPLEFORMAT_INT) return SampleForm{SampleForm::Kind::signed_whole, bytes};
  if (format == SAMPLEFORMAT_IEEEFP && bits > 8) return SampleForm{SampleForm::Kind::real, bytes};
  return std::nullopt;
}

// The format of a texel: a value, and optionally a second sample, which is 0 if the texel is not
// painted.
struct TiffForm {
  SampleForm sample;
  int samples = 1;
  bool is_separate = false;

  int pixel_bits() const { return 8 * sample.bytes * (is_separate ? 1 : samples); }
};

Result<void> check_compression(TIFF* tiff) {
  const auto compression = tiff_tag<std::uint16_t>(tiff, TIFFTAG_COMPRESSION);
  if (is_lossless(compression) && TIFFIsCODECConfigured(compression)) return {};
  return refuse_raster("The TIFF's compression (code " + std::to_string(compression) +
                       ") is not supported. Save it with deflate, LZW, zstd or no compression.");
}

Result<TiffForm> form_of(const Layer& layer, TIFF* tiff) {
  if (auto size = check_raster_size(layer, tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH),
                                    tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH));
      !size)
    return tl::unexpected(size.error());
  const int samples = tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL),
            bits = tiff_tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE),
            format = tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT);
  const auto sample = sample_form(bits, format);
  if (!sample)
    return refuse_raster(
        "The TIFF's samples have " + std::to_string(bits) + " bits and format " +
        std::to_string(format) +
        ". Save it with whole numbers of 8 to 64 bits, or floating-point numbers of 16 "
        "to 64 bits.");
  if (samples != 1 && samples != 2)
    return refuse_raster(
        "The TIFF has " + std::to_string(samples) + " samples of " + describe(*sample) +
        " per pixel. A layer needs one sample (the value), or two (the value, and 0 "
        "where nothing is painted).");
  STRATA_TRY(check_compression(tiff));
  return TiffForm{
      *sample, samples,
      samples > 1 && tiff_tag<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE};
}

// Calls visit(x, row, count, samples) for all pixels of one plane of the directory.
template <class Visit>
Result<void> visit_tiles(TIFF* tiff, const TiffMemory& file, std::uint32_t side, int pixel_bits,
                         std::uint16_t plane, Visit visit) {
  const auto tile_width = tiff_tag<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH),
             tile_height = tiff_tag<std::uint32_t>(tiff, TIFFTAG_TILELENGTH);
  const std::uint64_t row_bytes =
      (std::uint64_t{tile_width} * static_cast<unsigned>(pixel_bits) + 7) / 8;
  if (tile_width == 0 || tile_height == 0 || row_bytes > kMaxTiffTileBytes / tile_height)
    return refuse_raster("The TIFF's tiles are " + std::to_string(tile_width) + " × " +
                         std::to_string(tile_height) + ". Save it with tiles of 256 × 256.");
  std::vector<std::uint8_t> tile(row_bytes * tile_height);
  if (TIFFTileSize64(tiff) != tile.size()) return damaged(file);
  for (std::uint32_t top = 0; top < side; top += tile_height)
    for (std::uint32_t left = 0; left < side; left += tile_width) {
      if (TIFFReadTile(tiff, tile.data(), left, top, 0, plane) !=
          static_cast<tmsize_t>(tile.size()))
        return damaged(file);
      const auto columns = static_cast<int>(std::min(tile_width, side - left));
      for (std::uint32_t y = 0; y < std::min(tile_height, side - top); ++y)
        if (auto good = visit(static_cast<int>(left), static_cast<int>(top + y), columns,
                              tile.data() + y * row_bytes);
            !good)
          return good;
    }
  return {};
}

template <class Visit>
Result<void> visit_plane(TIFF* tiff, const TiffMemory& file, std::uint32_t side, int pixel_bits,
                         std::uint16_t plane, Visit visit) {
  if (TIFFIsTiled(tiff)) return visit_tiles(tiff, file, side, pixel_bits, plane, visit);
  std::vector<std::uint8_t> line((std::size_t{side} * static_cast<unsigned>(pixel_bits) + 7) / 8);
  if (TIFFScanlineSize64(tiff) != line.size()) return damaged(file);
  for (std::uint32_t row = 0; row < side; ++row) {
    if (TIFFReadScanline(tiff, line.data(), row, plane) != 1) return damaged(file);
    STRATA_TRY(visit(0, static_cast<int>(row), static_cast<int>(side), line.data()));
  }
  return {};
}

// The set of painted texels. It is read first if the file stores it separately from the values.
class Painted {
 public:
  explicit Painted(int side) : side_(static_cast<std::size_t>(side)) {}
  void set(int x, int row, bool painted) {
    if (bits_.empty()) bits_.resize(side_ * side_);
    bits_[static_cast<std::size_t>(row) * side_ + static_cast<std::size_t>(x)] = painted;
  }
  bool is_known() const { return !bits_.empty(); }
  bool at(int x, int row) const {
    return bits_[static_cast<std::size_t>(row) * side_ + static_cast<std::size_t>(x)];
  }

 private:
  std::size_t side_;
  std::vector<bool> bits_;
};

Result<void> read_valid_plane(TIFF* tiff, const TiffMemory& file, const Layer& layer,
                              const TiffForm& form, Painted& painted) {
  const SampleReader reader(layer, form.sample);
  return visit_plane(tiff, file, static_cast<std::uint32_t>(layer.resolution), form.pixel_bits(), 1,
                     [&](int x, int row, int count, const std::uint8_t* samples) -> Result<void> {
                       for (int i = 0; i < count; ++i, samples += form.sample.bytes)
                         painted.set(x + i, row, !reader.is_zero(samples));
                       return {};
                     });
}

// Searches for a mask. If the file has one, the mask becomes the current directory.
Result<bool> find_mask(TIFF* tiff, const TiffMemory& file) {
  for (int i = 1; i < kMaxDirectories && !TIFFLastDirectory(tiff); ++i) {
    if (!TIFFSetDirectory(tiff, static_cast<std::uint16_t>(i))) return damaged(file);
    const auto kind = tiff_tag<std::uint32_t>(tiff, TIFFTAG_SUBFILETYPE);
    if ((kind & FILETYPE_MASK) != 0 && (kind & FILETYPE_REDUCEDIMAGE) == 0) return true;
  }
  return false;
}

// Reads the internal mask of GDAL, with 1 or 8 bits per texel. Makes the first directory the
// current one again.
Result<void> read_mask(TIFF* tiff, TiffMemory& file, const Layer& layer, Painted& painted) {
  const auto has_mask = STRATA_TRY(find_mask(tiff, file));
  if (has_mask) {
    if (auto size = check_raster_size(layer, tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH),
                                      tiff_tag<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH));
        !size)
      return size;
    const int bits = tiff_tag<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
    if (tiff_tag<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL) != 1 || (bits != 1 && bits != 8))
      return refuse_raster("The mask of the TIFF does not have 1 or 8 bits per pixel.");
    STRATA_TRY(check_compression(tiff));
    STRATA_TRY(visit_plane(
        tiff, file, static_cast<std::uint32_t>(layer.resolution), bits, 0,
        [&](int x, int row, int count, const std::uint8_t* samples) -> Result<void> {
          for (int i = 0; i < count; ++i)
            painted.set(x + i, row,
                        bits == 8 ? samples[i] != 0 : (samples[i / 8] >> (7 - i % 8) & 1) != 0);
          return {};
        }));
  }
  if (!TIFFSetDirectory(tiff, 0)) return damaged(file);
  return {};
}

}  // namespace

Result<TileMap> decode_tiff(const Layer& layer, std::span<const std::uint8_t> bytes) {
  TiffMemory file{bytes, nullptr, 0, {}};
  Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  const auto form = STRATA_TRY(form_of(layer, tiff.get()));
  Painted painted(layer.resolution);
  const bool has_valid = form.samples == 2;
  const auto nodata = has_valid ? std::nullopt : nodata_of(tiff.get());
  if (has_valid && form.is_separate) {
    STRATA_TRY(read_valid_plane(tiff.get(), file, layer, form, painted));
  } else if (!has_valid) {
    STRATA_TRY(read_mask(tiff.get(), file, layer, painted));
  }
  TileMapBuilder builder(layer);
  const SampleReader reader(layer, form.sample, nodata);
  const int pixel_bytes = form.pixel_bits() / 8;
  const bool is_interleaved = has_valid && !form.is_separate;
  const auto put = [&](int x, int row, int count, const std::uint8_t* samples) -> Result<void> {
    for (int i = 0; i < count; ++i, samples += pixel_bytes) {
      if (painted.is_known() && !painted.at(x + i, row)) continue;
      if (is_interleaved && reader.is_zero(samples + form.sample.bytes)) continue;
      if (!has_valid && reader.is_nodata(samples)) continue;
      STRATA_TRY(reader.put(builder, x + i, row, samples));
    }
    return {};
  };
  STRATA_TRY(visit_plane(tiff.get(), file, static_cast<std::uint32_t>(layer.resolution),
                         form.pixel_bits(), 0, put));
  return builder.finish();
}

}  // namespace strata::query
