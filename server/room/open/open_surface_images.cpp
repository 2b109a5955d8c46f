#include "room/open/open_surface_images.h"

#include <algorithm>

#include "core/no_such.h"
#include "room/caches/surface_image_cache.h"
#include "room/open/open_participants.h"
#include "room/pipeline/strand.h"
#include "store/content/surface_images.h"
#include "store/store.h"

namespace strata::room {

std::vector<SurfaceImage> OpenRoom::SurfaceImagesPart::all() const {
  return room_.surface_image_cache_->all();
}

Result<SurfaceImage> OpenRoom::SurfaceImagesPart::find(const std::string& ref) const {
  if (auto image = room_.surface_image_cache_->find(ref)) return *image;
  return no_such("look", ref, "look");
}

Result<SurfaceImage> OpenRoom::SurfaceImagesPart::create(
    SurfaceImage image, std::span<const std::uint8_t> picture,
    const store::IdempotentResponse<SurfaceImage>& answer) {
  STRATA_TRY(room_.check_claimed());
  image.model_id = room_.model_id_;
  auto created = STRATA_TRY(room_.services_.store.surface_images().create(image, picture, answer));
  run_on(room_.strand_, [&] {
    ++room_.recovery_.metadata_changes;
    room_.surface_image_cache_->put(created);
    tell(Listener::LayerChange::created, created);
  });
  return created;
}

Result<SurfaceImage> OpenRoom::SurfaceImagesPart::update(
    const SurfaceImage& image, const store::IdempotentResponse<SurfaceImage>& answer) {
  STRATA_TRY(room_.check_claimed());
  auto updated = STRATA_TRY(room_.services_.store.surface_images().update(image, answer));
  run_on(room_.strand_, [&] {
    room_.surface_image_cache_->put(updated);
    tell(Listener::LayerChange::changed, updated);
  });
  return updated;
}

Result<void> OpenRoom::SurfaceImagesPart::erase(SurfaceImageId id,
                                                const store::IdempotentResponse<>& answer) {
  STRATA_TRY(room_.check_claimed());
  const auto known = room_.surface_image_cache_->find(to_string(id));
  STRATA_TRY(room_.services_.store.surface_images().remove(id, answer));
  run_on(room_.strand_, [&] {
    ++room_.recovery_.metadata_changes;
    room_.surface_image_cache_->drop(id);
    if (known) tell(Listener::LayerChange::deleted, *known);
  });
  return {};
}

void OpenRoom::SurfaceImagesPart::replace(const std::vector<SurfaceImage>& stored) {
  for (const SurfaceImage& image : stored) {
    const auto known = room_.surface_image_cache_->find(to_string(image.id));
    if (known && known->version >= image.version) continue;
    room_.surface_image_cache_->put(image);
    tell(known ? Listener::LayerChange::changed : Listener::LayerChange::created, image);
  }
  for (const SurfaceImage& known : all()) {
    if (std::ranges::any_of(stored, [&](const auto& image) { return image.id == known.id; }))
      continue;
    room_.surface_image_cache_->drop(known.id);
    tell(Listener::LayerChange::deleted, known);
  }
}

void OpenRoom::SurfaceImagesPart::tell(Listener::LayerChange change, const SurfaceImage& image) {
  room_.participants_part_->tell([&](Listener& l) { l.surface_image_changed(change, image); });
  room_.participants_part_->styles_changed();
}

}  // namespace strata::room
