#include "query/maps/geotiff.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <optional>

#include "core/text/markup.h"
#include "domain/people/question.h"
#include "media/tiff_memory.h"
#include "query/maps/geo_tags.h"
#include "query/rasters/tiff_tags.h"

namespace strata::query {
namespace {

// A value type for the file, and the bits of empty cells in it.
struct Band {
  ValueType type = ValueType::u8;
  std::uint32_t nodata = 0;
};

// Returns the first number that no cell has, of 0 and the numbers from the top of the type down.
// `used` are the numbers of the cells, sorted.
std::optional<double> free_number(const std::vector<double>& used, ValueType type) {
  if (!std::ranges::binary_search(used, 0.0)) return 0;
  double number = highest_value(type);
  for (auto at = used.rbegin(); at != used.rend() && *at >= number; ++at)
    if (*at == number) --number;
  return number >= lowest_value(type) ? std::optional(number) : std::nullopt;
}

std::vector<double> numbers_of(const PlaneRaster& raster) {
  std::vector<std::uint32_t> bits;
  for (std::size_t i = 0; i < raster.bits.size(); ++i)
    // Neighbors often have the same value.
    if (raster.valid[i] && (bits.empty() || bits.back() != raster.bits[i]))
      bits.push_back(raster.bits[i]);
  check_question();
  std::ranges::sort(bits);
  bits.erase(std::ranges::unique(bits).begin(), bits.end());
  std::vector<double> numbers;
  for (const std::uint32_t each : bits) numbers.push_back(decode_value(raster.type, each));
  std::ranges::sort(numbers);
  return numbers;
}

ValueType wider(ValueType type) {
  switch (type) {
    case ValueType::u8: return ValueType::u16;
    case ValueType::u16: return ValueType::u32;
    case ValueType::i8: return ValueType::i16;
    case ValueType::i16: return ValueType::i32;
    default: return type;
  }
}

Result<Band> band_of(const PlaneRaster& raster) {
  if (is_float(raster.type))
    return Band{ValueType::f32,
                std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN())};
  const std::vector<double> used = numbers_of(raster);
  for (ValueType type = raster.type;; type = wider(type)) {
    if (const auto nodata = free_number(used, type))
      return Band{type, encode_value(type, *nodata).value()};
    if (wider(type) == type)
      return fail(ErrorCode::conflict, "No number for empty cells",
                  "The raster contains every number of its type.");
  }
}

std::string number_text(ValueType type, std::uint32_t bits) {
  return is_float(type) ? "nan"
                        : std::to_string(static_cast<std::int64_t>(decode_value(type, bits)));
}

// The name and the unit of the band, as GDAL stores them.
std::string gdal_metadata(const GeoReference& reference) {
  std::string text = "<GDALMetadata>";
  const auto add = [&](const char* name, const char* role, const std::string& value) {
    if (!value.empty())
      text += std::string("<Item name=\"") + name + "\" sample=\"0\" role=\"" + role + "\">" +
              escaped_markup(value) + "</Item>";
  };
  add("DESCRIPTION", "description", reference.name);
  add("UNITTYPE", "unittype", reference.unit);
  return text + "</GDALMetadata>";
}

void describe(TIFF* tiff, const PlaneRaster& raster, const Band& band,
              const GeoReference& reference) {
  set_tiles(tiff, raster.width, raster.height);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * bytes_per_texel(band.type));
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, sample_format(band.type));
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_SOFTWARE, "Strata");
  TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, reference.name.c_str());
  set_nodata(tiff, number_text(band.type, band.nodata).c_str());
  set_geo_tags(tiff, reference.top_left, reference.cell, reference.epsg, reference.plane);
  set_gdal_metadata(tiff, gdal_metadata(reference));
}

bool write_tiles(TIFF* tiff, const PlaneRaster& raster, const Band& band) {
  const auto bytes = static_cast<std::size_t>(bytes_per_texel(band.type));
  std::vector<std::uint8_t> tile(kTiffTile * kTiffTile * bytes);
  for (int top = 0; top < raster.height; top += kTiffTile)
    for (int left = 0; left < raster.width; left += kTiffTile) {
      for (int y = 0; y < kTiffTile; ++y)
        for (int x = 0; x < kTiffTile; ++x) {
          std::uint32_t bits = band.nodata;
          if (top + y < raster.height && left + x < raster.width) {
            const std::size_t cell =
                static_cast<std::size_t>(top + y) * static_cast<std::size_t>(raster.width) +
                static_cast<std::size_t>(left + x);
            if (raster.valid[cell])
              bits = raster.type == band.type
                         ? raster.bits[cell]
                         : encode_value(band.type, decode_value(raster.type, raster.bits[cell]))
                               .value_or(band.nodata);
          }
          // The bits of a value are little-endian, as the machine and the file.
          std::memcpy(&tile[static_cast<std::size_t>(y * kTiffTile + x) * bytes], &bits, bytes);
        }
      if (TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(left),
                        static_cast<std::uint32_t>(top), 0, 0) < 0)
        return false;
      check_question();
    }
  return true;
}

}  // namespace

Result<std::vector<std::uint8_t>> encode_geotiff(const PlaneRaster& raster,
                                                 const GeoReference& reference) {
  const Band band = STRATA_TRY(band_of(raster));
  std::vector<std::uint8_t> out;
  TiffMemory file{{}, &out, 0, {}};
  const auto failed = [&] {
    return fail(ErrorCode::internal, "TIFF not written", "libtiff: " + file.complaint);
  };
  Tiff tiff = open_tiff(file, "wm");
  if (!tiff) return failed();
  describe(tiff.get(), raster, band, reference);
  if (!write_tiles(tiff.get(), raster, band)) return failed();
  tiff.reset();
  if (!file.complaint.empty()) return failed();
  return out;
}

}  // namespace strata::query
