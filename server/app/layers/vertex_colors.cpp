#include "app/layers/vertex_colors.h"

#include "core/memory_ledger.h"
#include "domain/people/role.h"
#include "media/picture.h"
#include "query/sampling/values.h"
#include "room/caches/record_colors.h"
#include "room/caches/surface_image_cache.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "room/surface_images.h"
#include "room/view_settings.h"
#include "store/content/surface_images.h"
#include "store/store.h"

namespace strata::app {
namespace {

Result<void> add_photo(const Services& services, const room::SurfaceImageView& image,
                       query::VertexColors& colors) {
  const auto encoded = STRATA_TRY(services.store.surface_images().picture(image.surface_image_id));
  const auto info = STRATA_TRY(inspect_picture(encoded));
  // Decoding needs at most twice the memory of the pixels.
  const auto bytes =
      static_cast<std::uint64_t>(info.width) * static_cast<std::uint64_t>(info.height) * 8;
  const auto share = STRATA_TRY(services.rooms.memory().reserve(bytes, "a photo of the surface"));
  const auto photo = STRATA_TRY(decode_picture(encoded));
  colors.add_photo(photo, image.opacity);
  return {};
}

Result<query::DrawnLayer> drawn(const Services& services, Role role, const query::LayerView& view) {
  auto palette = std::make_shared<const Palette>(view.layer.palette);
  if (view.layer.table && room::RecordColors::needs_records(*palette, nullptr)) {
    auto by_key = STRATA_TRY(room::RecordColors::make(
        services.store, {*view.layer.table, sight_of(role), palette, nullptr}));
    palette = std::move(by_key);
  }
  return query::DrawnLayer{view.snapshot.tiles, view.layer.resolution, view.layer.type,
                           std::move(palette),  view.layer.opacity,    view.layer.blend};
}

}  // namespace

Result<ComposedVertices> compose_vertices(const Services& services, room::Room& room, Role role,
                                          const std::vector<query::LayerView>& bottom_to_top) {
  const auto images = room::surface_images_shown(room.surface_images().all());
  const auto geometry = room.surface().geometry();
  const std::uint64_t bytes = images.empty() ? 0 : geometry->vertices.size() * 3;
  auto memory =
      STRATA_TRY(services.rooms.memory().reserve(bytes, "the colors of a model's vertices"));
  ComposedVertices composed{query::VertexColors(geometry), std::move(memory)};
  for (const room::SurfaceImageView& image : images)
    STRATA_TRY(add_photo(services, image, composed.colors));
  for (const query::LayerView& view : bottom_to_top) {
    auto layer = STRATA_TRY(drawn(services, role, view));
    composed.colors.add_layer(std::move(layer));
  }
  return composed;
}

}  // namespace strata::app
