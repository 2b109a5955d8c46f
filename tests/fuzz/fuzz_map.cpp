// Fuzzes flat maps. The input is a TIFF, a GeoJSON text, or a .shp with the length in its header,
// directly followed by its .dbf.
#include <cmath>
#include <cstdlib>

#include "query/maps/geojson.h"
#include "query/maps/map_tiff.h"
#include "query/maps/shapefile.h"

namespace {

using strata::query::FeatureMap;

constexpr int kMaxSide = 512;  // of images; larger images only take longer

void check(bool good) {
  if (!good) std::abort();
}

void check_map(const FeatureMap& map) {
  for (const auto& feature : map.features) {
    check(feature.values.size() <= map.columns.size());
    for (const auto& rings : feature.polygons)
      for (const auto& ring : rings) {
        check(ring.size() >= 3);
        for (const auto& point : ring) check(std::isfinite(point.x) && std::isfinite(point.y));
      }
  }
  for (const auto& column : strata::query::columns_of(map)) {
    strata::query::KeyNames keys({strata::PaletteMode::categorical, 0, 1, {}, {}}, {});
    const auto flat = strata::query::flat_map(map, {column.name, 0, ""}, &keys);
    if (flat) check(flat->areas().empty() || !flat->value_at({NAN, 0}));
  }
}

void read_tiff(std::span<const std::uint8_t> bytes) {
  const auto info = strata::query::inspect_tiff(bytes, kMaxSide);
  if (!info) return;
  const auto pixels =
      static_cast<std::size_t>(info->width) * static_cast<std::size_t>(info->height);
  if (const auto band = strata::query::decode_tiff_band(bytes, *info, info->bands))
    check(band->bits.size() == pixels);
  if (const auto picture = strata::query::decode_tiff_picture(bytes, *info))
    check(picture->rgba.size() == 4 * pixels);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  if (strata::query::is_tiff(bytes)) {
    read_tiff(bytes);
  } else if (strata::query::is_shapefile(bytes) && size >= 28) {
    const std::size_t words = std::size_t{data[24]} << 24 | std::size_t{data[25]} << 16 |
                              std::size_t{data[26]} << 8 | data[27];
    const std::size_t shp = std::min(size, 2 * words);
    if (const auto map =
            strata::query::parse_shapefile({bytes.first(shp), bytes.subspan(shp), "", ""}))
      check_map(*map);
  } else {
    if (const auto map = strata::query::parse_geojson({reinterpret_cast<const char*>(data), size}))
      check_map(*map);
  }
  return 0;
}
