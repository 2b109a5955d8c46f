#include "app/layers/vertex_colors.h"

#include "app/layers/drawn_layers.h"
#include "core/memory_ledger.h"
#include "room/caches/surface_image_cache.h"
#include "room/room.h"
#include "room/rooms.h"
#include "room/surface.h"
#include "room/surface_images.h"
#include "room/view_settings.h"

namespace strata::app {

Result<ComposedVertices> compose_vertices(const Services& services, room::Room& room, Role role,
                                          const std::vector<query::LayerView>& bottom_to_top) {
  const auto images = room::surface_images_shown(room.surface_images().all());
  const auto geometry = room.surface().geometry();
  const std::uint64_t bytes = images.empty() ? 0 : geometry->vertices.size() * 3;
  auto memory =
      STRATA_TRY(services.rooms.memory().reserve(bytes, "the colors of a model's vertices"));
  ComposedVertices composed{query::VertexColors(geometry), std::move(memory)};
  for (const room::SurfaceImageView& image : images) {
    const auto photo = STRATA_TRY(decode_photo(services, image));
    composed.colors.add_photo(photo.picture, image.opacity);
  }
  for (const query::LayerView& view : bottom_to_top) {
    auto layer = STRATA_TRY(drawn_layer(services, role, view));
    composed.colors.add_layer(std::move(layer));
  }
  return composed;
}

}  // namespace strata::app
