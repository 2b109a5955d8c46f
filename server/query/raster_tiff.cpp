#include <algorithm>
#include <cstring>
#include <string>

#include "core/tiff_memory.h"
#include "query/raster.h"
#include "query/raster_rows.h"

namespace strata::query {
namespace {

constexpr int kTiffTile = 256;

std::uint16_t sample_format(ValueType type) {
  if (is_float(type)) return SAMPLEFORMAT_IEEEFP;
  return lowest_value(type) < 0 ? SAMPLEFORMAT_INT : SAMPLEFORMAT_UINT;
}

std::uint32_t one_of(ValueType type) { return *encode_value(type, 1); }

std::string describe(int samples, int bits, int format) {
  const char* kind = "unknown samples";
  if (format == SAMPLEFORMAT_UINT) kind = "unsigned whole numbers";
  if (format == SAMPLEFORMAT_INT) kind = "signed whole numbers";
  if (format == SAMPLEFORMAT_IEEEFP) kind = "floating-point numbers";
  return std::to_string(samples) + (samples == 1 ? " sample" : " samples") + " of " + std::to_string(bits) + "-bit " +
         kind;
}

Result<void> check_form(const Layer& layer, TIFF* tiff) {
  std::uint32_t width = 0, height = 0;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  if (auto size = check_raster_size(layer, width, height); !size) return size;
  std::uint16_t samples = 0, bits = 0, format = 0, planes = 0, compression = 0;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planes);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
  const int needed_bits = 8 * bytes_per_texel(layer.type);
  if (samples != 2 || bits != needed_bits || format != sample_format(layer.type))
    return refuse_raster("The TIFF has " + describe(samples, bits, format) + ", but the layer needs " +
                         describe(2, needed_bits, sample_format(layer.type)) +
                         " (the value, then 1 where it is valid and 0 elsewhere).");
  if (planes != PLANARCONFIG_CONTIG)
    return refuse_raster("The TIFF keeps its two samples in separate planes; save it interleaved (by pixel).");
  if (!is_lossless(compression) || !TIFFIsCODECConfigured(compression))
    return refuse_raster("The TIFF's compression (code " + std::to_string(compression) +
                         ") is not accepted; save it with deflate, LZW, zstd or none.");
  return {};
}

// One row of samples, value and valid, into the builder.
Result<void> put_samples(TileMapBuilder& builder, const Layer& layer, const std::uint8_t* samples, int x, int row,
                         int count) {
  const int width = bytes_per_texel(layer.type);
  for (int i = 0; i < count; ++i, samples += 2 * width) {
    std::uint32_t valid = 0;
    std::memcpy(&valid, samples + width, width);
    if (valid == 0 || decode_value(layer.type, valid) == 0) continue;
    if (auto put = builder.put(x + i, row, samples); !put) return put;
  }
  return {};
}

tl::unexpected<Problem> damaged(const TiffMemory& file) {
  return refuse_raster(
      "The TIFF cannot be read: " + (file.complaint.empty() ? std::string("damaged") : file.complaint) + ".");
}

Result<void> read_tiles(const Layer& layer, TIFF* tiff, const TiffMemory& file, TileMapBuilder& builder) {
  std::uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tile_height);
  const std::uint64_t pixel_bytes = 2u * bytes_per_texel(layer.type), row_bytes = tile_width * pixel_bytes;
  if (tile_width == 0 || tile_height == 0 || row_bytes > kMaxTiffTileBytes / tile_height)
    return refuse_raster("The TIFF's tiles are " + std::to_string(tile_width) + " × " + std::to_string(tile_height) +
                         "; save it with tiles of 256 × 256.");
  std::vector<std::uint8_t> tile(row_bytes * tile_height);
  if (TIFFTileSize64(tiff) != tile.size()) return damaged(file);
  const auto side = static_cast<std::uint32_t>(layer.resolution);
  for (std::uint32_t top = 0; top < side; top += tile_height)
    for (std::uint32_t left = 0; left < side; left += tile_width) {
      if (TIFFReadTile(tiff, tile.data(), left, top, 0, 0) != static_cast<tmsize_t>(tile.size())) return damaged(file);
      const int columns = static_cast<int>(std::min(tile_width, side - left));
      for (std::uint32_t y = 0; y < std::min(tile_height, side - top); ++y)
        if (auto put = put_samples(builder, layer, tile.data() + y * row_bytes, left, top + y, columns); !put)
          return put;
    }
  return {};
}

Result<void> read_scanlines(const Layer& layer, TIFF* tiff, const TiffMemory& file, TileMapBuilder& builder) {
  std::vector<std::uint8_t> line(std::size_t(layer.resolution) * 2 * bytes_per_texel(layer.type));
  if (TIFFScanlineSize64(tiff) != line.size()) return damaged(file);
  for (int row = 0; row < layer.resolution; ++row) {
    if (TIFFReadScanline(tiff, line.data(), static_cast<std::uint32_t>(row), 0) != 1) return damaged(file);
    if (auto put = put_samples(builder, layer, line.data(), 0, row, layer.resolution); !put) return put;
  }
  return {};
}

void describe_form(TIFF* tiff, const Layer& layer) {
  const auto side = static_cast<std::uint32_t>(layer.resolution);
  const std::uint16_t not_alpha = EXTRASAMPLE_UNSPECIFIED;
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, side);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, side);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 2);
  TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &not_alpha);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * bytes_per_texel(layer.type));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, sample_format(layer.type));
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
  TIFFSetField(tiff, TIFFTAG_ZIPQUALITY, 3);
  TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kTiffTile);
  TIFFSetField(tiff, TIFFTAG_TILELENGTH, kTiffTile);
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, "Strata");
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, ("Layer " + layer.name + ": value, then valid (1 or 0)").c_str());
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_tiff(const Layer& layer, const TileMap& tiles) {
  std::vector<std::uint8_t> out;
  TiffMemory file{{}, &out, 0, {}};
  auto failed = [&] { return fail(500, "TIFF not written", "libtiff: " + file.complaint); };
  Tiff tiff = open_tiff(file, "wm");
  if (!tiff) return failed();
  describe_form(tiff.get(), layer);

  const int side = layer.resolution, width = bytes_per_texel(layer.type);
  const std::uint32_t one = one_of(layer.type);
  const TileRows rows(layer, tiles);
  std::vector<std::uint32_t> bits(std::size_t(side) * kTiffTile);
  std::vector<std::uint8_t> valid(bits.size()), tile(std::size_t(kTiffTile) * kTiffTile * 2 * width);
  for (int top = 0; top < side; top += kTiffTile) {
    const int height = std::min(kTiffTile, side - top);
    for (int y = 0; y < height; ++y)
      rows.read(top + y, std::span(bits).subspan(std::size_t(y) * side, side),
                std::span(valid).subspan(std::size_t(y) * side, side));
    for (int left = 0; left < side; left += kTiffTile) {
      std::fill(tile.begin(), tile.end(), std::uint8_t{0});
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < std::min(kTiffTile, side - left); ++x) {
          const std::size_t from = std::size_t(y) * side + left + x;
          if (!valid[from]) continue;
          std::uint8_t* to = tile.data() + (std::size_t(y) * kTiffTile + x) * 2 * width;
          std::memcpy(to, &bits[from], width);
          std::memcpy(to + width, &one, width);
        }
      if (TIFFWriteTile(tiff.get(), tile.data(), left, top, 0, 0) < 0) return failed();
    }
  }
  if (!TIFFWriteDirectory(tiff.get())) return failed();
  tiff.reset();
  if (!file.complaint.empty()) return failed();
  return out;
}

Result<TileMap> decode_tiff(const Layer& layer, std::span<const std::uint8_t> bytes) {
  TiffMemory file{bytes, nullptr, 0, {}};
  Tiff tiff = open_tiff(file, "rm");
  if (!tiff) return damaged(file);
  if (auto form = check_form(layer, tiff.get()); !form) return tl::unexpected(form.error());
  TileMapBuilder builder(layer);
  const auto read = TIFFIsTiled(tiff.get()) ? read_tiles(layer, tiff.get(), file, builder)
                                            : read_scanlines(layer, tiff.get(), file, builder);
  if (!read) return tl::unexpected(read.error());
  return builder.finish();
}

}  // namespace strata::query
