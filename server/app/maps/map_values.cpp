#include "app/maps/map_values.h"

#include "app/maps/map_legend.h"
#include "query/maps/color_keys.h"
#include "query/maps/geojson.h"
#include "query/maps/shapefile.h"
#include "query/rasters/placed_picture.h"

namespace strata::app {
namespace {

Result<void> check_kind(const MapFiles& files, bool polygons) {
  const bool is_polygons = files.kind() == MapKind::geojson || files.kind() == MapKind::shapefile;
  if (is_polygons == polygons) return {};
  return fail(ErrorCode::unsupported, polygons ? "No polygons" : "Not a picture",
              polygons ? "Send polygons as GeoJSON or as a shapefile. Send pictures to `picture`."
                       : "Send a picture as PNG, JPEG or TIFF. Send polygons to `polygons`.",
              "body");
}

// Returns colors with their keys. These are the requested colors, or the colors found in the image.
Result<std::vector<query::ColorKey>> color_keys(const std::string& requested,
                                                const Picture& picture, double tolerance) {
  if (requested != "auto") return query::parse_color_keys(requested, "colors");
  std::vector<query::ColorKey> keys;
  for (const query::FoundColor& found : query::find_colors(picture, tolerance))
    if (!found.is_background) keys.push_back({found.color, static_cast<double>(keys.size() + 1)});
  if (keys.empty())
    return fail(ErrorCode::invalid, "No colors", "The picture contains only its background color.",
                "colors");
  return keys;
}

Result<MapValues> values_by_color(const MapOptions& options, MapPicture map,
                                  const MapTarget& target) {
  const auto colors = STRATA_TRY(color_keys(*options.colors, map.picture, options.tolerance));
  auto keys = STRATA_TRY(keys_of(target.room, target.layer, target.records));
  for (const query::ColorKey& key : colors) {
    STRATA_TRY(bits_of(target.layer, key.value, ""));
    if (keys) keys->color(key.value, key.color);
  }
  const auto placed = std::make_shared<query::PlacedPicture>(std::move(map.picture), map.world);
  const auto bits_at = [placed, held = map.held, type = target.layer.type,
                        by_color = query::ColorKeys(colors, options.tolerance)](
                           const glm::dvec2& place) -> std::optional<std::uint32_t> {
    const std::uint8_t* pixel = placed->pixel_at(place);
    const auto value = pixel ? by_color.value_of(pixel) : std::nullopt;
    if (!value) return std::nullopt;
    return *encode_value(type, *value);
  };
  return MapValues{bits_at, std::move(keys)};
}

Result<MapValues> values_by_luminance(MapPicture map, const Layer& layer) {
  for (const double luminance : {0.0, 255.0})
    STRATA_TRY(bits_of(layer, luminance, "Luminance has values from 0 to 255. "));
  const auto placed = std::make_shared<query::PlacedPicture>(std::move(map.picture), map.world);
  const auto bits_at = [placed, held = map.held, type = layer.type](
                           const glm::dvec2& place) -> std::optional<std::uint32_t> {
    const auto luminance = placed->luminance_at(place);
    if (!luminance) return std::nullopt;
    return *encode_value(type, *luminance);
  };
  return MapValues{bits_at, std::nullopt};
}

// Converts every number of the band, even outside the surface, because a failure must not depend on
// the surface.
Result<void> convert(query::BandRaster& band, const Layer& layer) {
  for (std::size_t i = 0; i < band.bits.size(); ++i) {
    if (!band.valid[i]) continue;
    const auto bits = encode_value(layer.type, decode_value(band.type, band.bits[i]));
    if (!bits) {
      const auto width = static_cast<std::size_t>(band.width);
      return tl::unexpected(
          bits_of(layer, decode_value(band.type, band.bits[i]),
                  "Pixel " + std::to_string(i % width) + ", " + std::to_string(i / width) + ": ")
              .error());
    }
    band.bits[i] = *bits;
  }
  return {};
}

Result<MapValues> values_of_band(const MapFiles& files, const query::MapTiff& tiff, int number,
                                 const query::WorldFile& world, std::shared_ptr<const void> held,
                                 const Layer& layer) {
  auto read = STRATA_TRY(query::decode_tiff_band(files.main(), tiff, number));
  STRATA_TRY(convert(read, layer));
  const auto band = std::make_shared<const query::BandRaster>(std::move(read));
  const auto bits_at = [band, held = std::move(held),
                        finder = query::PixelFinder(band->width, band->height, world)](
                           const glm::dvec2& place) -> std::optional<std::uint32_t> {
    const auto pixel = finder.pixel_at(place);
    if (!pixel || !band->valid[*pixel]) return std::nullopt;
    return band->bits[*pixel];
  };
  return MapValues{bits_at, std::nullopt};
}

std::uint64_t pixels(int width, int height) {
  return static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
}

}  // namespace

Result<query::FeatureMap> features_of(const MapFiles& files, const Model& model) {
  STRATA_TRY(check_kind(files, true));
  auto map =
      files.kind() == MapKind::geojson
          ? query::parse_geojson(files.text())
          : query::parse_shapefile({files.main(), files.companion({"dbf"}),
                                    files.companion_text({"cpg"}), files.companion_text({"prj"})});
  if (!map) return map;
  STRATA_TRY(check_map_crs(model, map->crs, map->in_degrees));
  return map;
}

Result<MapValues> polygon_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget&) {
  query::MapChoice choice;
  choice.attribute = options.attribute;
  choice.names = options.names;
  if (choice.attribute.empty() == !options.value)
    return fail(ErrorCode::invalid, "Parameter missing",
                "Send either `value` or `attribute`, but not both.", "value");
  if (!choice.names.empty() && choice.attribute.empty())
    return fail(ErrorCode::invalid, "Parameter missing",
                "`names` contains names for the numbers in an attribute. Send `attribute` too.",
                "names");
  choice.value = options.value.value_or(0);
  const auto features = STRATA_TRY(features_of(files, target.room.model()));
  STRATA_TRY(confirm_map_crs(options, target.room.model(), features.crs));
  std::optional<query::KeyNames> keys;
  if (!choice.attribute.empty()) {
    auto found = STRATA_TRY(keys_of(target.room, target.layer, target.records));
    keys = std::move(found);
  }
  auto map = query::flat_map(features, choice, keys ? &*keys : nullptr);
  if (!map) return tl::unexpected(map.error());
  for (const query::MapArea& area : map->areas()) STRATA_TRY(bits_of(target.layer, area.value, ""));
  const auto bits_at =
      [map = std::make_shared<const query::FlatMap>(std::move(*map)),
       type = target.layer.type](const glm::dvec2& place) -> std::optional<std::uint32_t> {
    const auto found = map->value_at(place);
    if (!found) return std::nullopt;
    return *encode_value(type, *found);
  };
  return MapValues{bits_at, std::move(keys)};
}

Result<std::optional<query::MapTiff>> tiff_of(const MapFiles& files, const Model& model) {
  STRATA_TRY(check_kind(files, false));
  if (files.kind() != MapKind::tiff) return std::nullopt;
  auto tiff = STRATA_TRY(query::inspect_tiff(files.main(), kMaxMapSide));
  STRATA_TRY(check_map_crs(model, tiff.crs, tiff.in_degrees));
  return std::optional(std::move(tiff));
}

Result<Picture> picture_of(const MapFiles& files, const std::optional<query::MapTiff>& tiff) {
  return tiff ? query::decode_tiff_picture(files.main(), *tiff)
              : decode_picture(files.main(), kMaxMapSide);
}

Result<std::shared_ptr<const void>> budget_of(const MapFiles& files,
                                              const std::optional<query::MapTiff>& tiff,
                                              ByteBudget& budget) {
  // Decoding a TIFF needs twice four bytes per pixel.
  if (tiff) return budget.take(8 * pixels(tiff->width, tiff->height));
  const auto info = STRATA_TRY(inspect_picture(files.main(), kMaxMapSide));
  return budget.take(4 * pixels(info.width, info.height));
}

Result<MapPicture> map_picture(const MapOptions& options, const MapFiles& files, const Model& model,
                               ByteBudget& budget) {
  const auto tiff = STRATA_TRY(tiff_of(files, model));
  if (auto confirmed = confirm_map_crs(options, model, tiff ? tiff->crs : std::string());
      !confirmed)
    return tl::unexpected(confirmed.error());
  const auto world = STRATA_TRY(world_of(options, files, tiff ? tiff->world : std::nullopt));
  auto held = STRATA_TRY(budget_of(files, tiff, budget));
  auto picture = STRATA_TRY(picture_of(files, tiff));
  return MapPicture{std::move(picture), world, std::move(held)};
}

Result<MapValues> picture_values(const MapOptions& options, const MapFiles& files,
                                 const MapTarget& target, ByteBudget& budget) {
  const bool by_color = options.colors.has_value();
  if (by_color && options.band)
    return fail(ErrorCode::invalid, "Too many parameters",
                "Send either `band` or `colors`, but not both.", "colors");
  const auto tiff = STRATA_TRY(tiff_of(files, target.room.model()));
  if (auto confirmed =
          confirm_map_crs(options, target.room.model(), tiff ? tiff->crs : std::string());
      !confirmed)
    return tl::unexpected(confirmed.error());
  const bool has_one_band = tiff && tiff->bands == 1 && tiff->has_numbers;
  const bool by_band = options.band || (has_one_band && !by_color);
  if (!by_band) {
    auto map = STRATA_TRY(map_picture(options, files, target.room.model(), budget));
    return by_color ? values_by_color(options, std::move(map), target)
                    : values_by_luminance(std::move(map), target.layer);
  }
  if (!tiff)
    return fail(ErrorCode::invalid, "No bands in picture",
                "You can use `band` only with TIFF files. Leave it out.", "band");
  const auto world = STRATA_TRY(world_of(options, files, tiff->world));
  auto held = STRATA_TRY(budget_of(files, tiff, budget));
  return values_of_band(files, *tiff, options.band.value_or(1), world, std::move(held),
                        target.layer);
}

}  // namespace strata::app
