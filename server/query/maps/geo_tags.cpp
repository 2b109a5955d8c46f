#include "query/maps/geo_tags.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

namespace strata::query {
namespace {

constexpr std::uint32_t kPixelScale = 33550, kTiepoint = 33922, kTransformation = 34264,
                        kGeoKeys = 34735, kGeoTexts = 34737, kGdalMetadata = 42112, kNodata = 42113;
constexpr std::uint16_t kModelType = 1024, kRasterType = 1025, kCitation = 1026, kProjected = 3072,
                        kLengthUnit = 3076;
constexpr std::uint16_t kProjectedModel = 1, kGeographic = 2, kPixelIsArea = 1, kPixelIsPoint = 2,
                        kMeter = 9001;
constexpr std::uint16_t kUserDefined = 32767;

// libtiff reads unknown tags as lists of the type given in the file.
template <class T>
std::span<const T> list_of(TIFF* tiff, std::uint32_t tag, TIFFDataType type) {
  const TIFFField* field = TIFFFindField(tiff, tag, TIFF_ANY);
  if (!field || TIFFFieldDataType(field) != type || !TIFFFieldPassCount(field)) return {};
  const T* list = nullptr;
  std::uint32_t count = 0;
  if (TIFFFieldReadCount(field) == TIFF_VARIABLE2) {
    if (!TIFFGetField(tiff, tag, &count, &list)) return {};
  } else {
    std::uint16_t few = 0;
    if (!TIFFGetField(tiff, tag, &few, &list)) return {};
    count = few;
  }
  return list ? std::span<const T>(list, count) : std::span<const T>();
}

struct GeoKeys {
  bool is_point = false, is_geographic = false;
  int projected = 0;
};

GeoKeys read_keys(TIFF* tiff) {
  GeoKeys keys;
  const auto list = list_of<std::uint16_t>(tiff, kGeoKeys, TIFF_SHORT);
  for (std::size_t at = 4; at + 4 <= list.size(); at += 4) {
    const std::uint16_t key = list[at], elsewhere = list[at + 1], value = list[at + 3];
    if (elsewhere != 0) continue;
    if (key == kRasterType) keys.is_point = value == kPixelIsPoint;
    if (key == kModelType) keys.is_geographic = value == kGeographic;
    if (key == kProjected && value != kUserDefined) keys.projected = value;
  }
  return keys;
}

// Moves the position of the first pixel by `half` a pixel: from its corner to its center.
WorldFile shifted(WorldFile world, double half) {
  world.x += half * (world.x_per_column + world.x_per_row);
  world.y += half * (world.y_per_column + world.y_per_row);
  return world;
}

}  // namespace

std::optional<double> nodata_of(TIFF* tiff) {
  const auto text = list_of<char>(tiff, kNodata, TIFF_ASCII);
  std::string_view number(text.data(), text.size());
  number = number.substr(0, number.find('\0'));
  while (!number.empty() && number.front() == ' ') number.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
  return !number.empty() && error == std::errc() && std::isfinite(value) ? std::optional(value)
                                                                         : std::nullopt;
}

void set_nodata(TIFF* tiff, const char* number) {
  static char name[] = "GDALNoDataValue";  // libtiff does not copy the name
  static const TIFFFieldInfo field{kNodata, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name};
  TIFFMergeFieldInfo(tiff, &field, 1);
  TIFFSetField(tiff, kNodata, number);
}

void set_gdal_metadata(TIFF* tiff, const std::string& xml) {
  static char name[] = "GDALMetadata";
  static const TIFFFieldInfo field{kGdalMetadata, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, name};
  TIFFMergeFieldInfo(tiff, &field, 1);
  TIFFSetField(tiff, kGdalMetadata, xml.c_str());
}

void set_geo_tags(TIFF* tiff, const glm::dvec2& top_left, const glm::dvec2& cell, int epsg,
                  const std::string& plane) {
  static char scale_name[] = "ModelPixelScale", tie_name[] = "ModelTiepoint",
              keys_name[] = "GeoKeyDirectory", texts_name[] = "GeoAsciiParams";
  static const TIFFFieldInfo fields[] = {
      {kPixelScale, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, scale_name},
      {kTiepoint, -1, -1, TIFF_DOUBLE, FIELD_CUSTOM, 1, 1, tie_name},
      {kGeoKeys, -1, -1, TIFF_SHORT, FIELD_CUSTOM, 1, 1, keys_name},
      {kGeoTexts, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, texts_name}};
  TIFFMergeFieldInfo(tiff, fields, std::size(fields));
  const double scale[] = {cell.x, cell.y, 0}, tie[] = {0, 0, 0, top_left.x, top_left.y, 0};
  TIFFSetField(tiff, kPixelScale, 3, scale);
  TIFFSetField(tiff, kTiepoint, 6, tie);
  // Each entry of the directory: key, tag of the value (0: the value is here), count, value.
  std::vector<std::uint16_t> keys{1, 1, 1, 0};
  const auto add = [&](std::uint16_t key, std::uint16_t tag, std::uint16_t count,
                       std::uint16_t value) {
    keys.insert(keys.end(), {key, tag, count, value});
    ++keys[3];
  };
  const bool is_projected = epsg > 0 && epsg < kUserDefined;
  add(kModelType, 0, 1, is_projected ? kProjectedModel : kUserDefined);
  add(kRasterType, 0, 1, kPixelIsArea);
  if (is_projected) {
    add(kProjected, 0, 1, static_cast<std::uint16_t>(epsg));
  } else {
    std::string citation = epsg > 0 ? "EPSG:" + std::to_string(epsg) : plane;
    std::ranges::replace(citation, '|', '/');  // `|` ends a text
    citation += '|';
    add(kCitation, kGeoTexts, static_cast<std::uint16_t>(citation.size()), 0);
    TIFFSetField(tiff, kGeoTexts, citation.c_str());
  }
  add(kLengthUnit, 0, 1, kMeter);
  TIFFSetField(tiff, kGeoKeys, static_cast<int>(keys.size()), keys.data());
}

Result<void> read_geo_tags(TIFF* tiff, MapTiff& info) {
  info.nodata = nodata_of(tiff);
  const GeoKeys keys = read_keys(tiff);
  info.in_degrees = keys.is_geographic;
  if (keys.projected > 0) info.crs = "EPSG:" + std::to_string(keys.projected);
  std::optional<WorldFile> world;
  const auto matrix = list_of<double>(tiff, kTransformation, TIFF_DOUBLE);
  const auto scale = list_of<double>(tiff, kPixelScale, TIFF_DOUBLE),
             tie = list_of<double>(tiff, kTiepoint, TIFF_DOUBLE);
  if (matrix.size() >= 16)
    world = WorldFile{matrix[0], matrix[4], matrix[1], matrix[5], matrix[3], matrix[7]};
  else if (scale.size() >= 2 && tie.size() == 6)
    world = WorldFile{
        scale[0], 0, 0, -scale[1], tie[3] - tie[0] * scale[0], tie[4] + tie[1] * scale[1]};
  if (!world) return {};
  auto good = STRATA_TRY(checked(shifted(*world, keys.is_point ? 0 : 0.5), "body"));
  info.world = good;
  return {};
}

}  // namespace strata::query
