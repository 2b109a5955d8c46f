#include "app/layers/drawn_layers.h"

#include "domain/layers/layer.h"
#include "mesh/texture/texture_sampler.h"
#include "room/caches/record_colors.h"
#include "room/caches/surface_image_cache.h"
#include "room/queries.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "room/surface_images.h"
#include "store/content/surface_images.h"
#include "store/store.h"

namespace strata::app {

Result<DecodedPhoto> decode_photo(const Services& services, const room::SurfaceImageView& image) {
  const auto encoded = STRATA_TRY(services.store.surface_images().picture(image.surface_image_id));
  const auto info = STRATA_TRY(inspect_picture(encoded));
  // Decoding needs at most twice the memory of the pixels.
  const auto bytes =
      static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height) * 8;
  auto share = STRATA_TRY(services.rooms.memory().reserve(bytes, "a photo of the surface"));
  auto picture = STRATA_TRY(decode_picture(encoded));
  return DecodedPhoto{std::move(picture), std::move(share)};
}

Result<query::DrawnLayer> drawn_layer(const Services& services, Role role,
                                      const query::LayerView& view,
                                      const room::LayerView& settings) {
  auto palette = std::make_shared<const Palette>(settings.palette.value_or(view.layer.palette));
  const auto highlight =
      settings.highlight ? std::make_shared<const room::Highlight>(*settings.highlight) : nullptr;
  if (view.layer.table && room::RecordColors::needs_records(*palette, highlight)) {
    auto by_key = STRATA_TRY(room::RecordColors::make(
        services.store, {*view.layer.table, sight_of(role), palette, highlight}));
    palette = std::move(by_key);
  }
  return query::DrawnLayer{view.snapshot.tiles,
                           view.layer.resolution,
                           view.layer.type,
                           std::move(palette),
                           settings.opacity.value_or(view.layer.opacity),
                           view.layer.blend};
}

Result<ComposedSurface> compose_surface(const Services& services, room::Room& room, Role role,
                                        const std::vector<Layer>& bottom_to_top,
                                        const room::ViewSettings& shown, room::At at,
                                        std::optional<int> pixels) {
  ComposedSurface composed{query::SurfaceColors(room.surface().geometry()), {}};
  const auto images =
      shown.images.value_or(room::surface_images_shown(room.surface_images().all()));
  for (const room::SurfaceImageView& image : images) {
    DecodedPhoto photo = STRATA_TRY(decode_photo(services, image));
    while (pixels && mesh::halve_toward(photo.picture, *pixels)) {
    }
    composed.colors.add_photo(std::move(photo.picture), image.opacity);
    composed.memory.push_back(std::move(photo.memory));
  }
  for (const Layer& layer : bottom_to_top) {
    auto tiles = STRATA_TRY(room.queries().tiles(to_string(layer.id), at));
    query::DrawnLayer drawn =
        STRATA_TRY(drawn_layer(services, role, {layer, std::move(tiles)}, shown.of(layer.id)));
    composed.colors.add_layer(std::move(drawn));
  }
  return composed;
}

}  // namespace strata::app
