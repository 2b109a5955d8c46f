#include "room/open/open_looks.h"

#include "core/no_such.h"
#include "room/caches/surface_image_cache.h"
#include "room/open/open_participants.h"
#include "room/pipeline/strand.h"
#include "store/content/looks.h"
#include "store/store.h"

namespace strata::room {

std::vector<Look> OpenRoom::LooksPart::all() const { return room_.surface_image_cache_->all(); }

Result<Look> OpenRoom::LooksPart::find(const std::string& ref) const {
  if (auto look = room_.surface_image_cache_->find(ref)) return *look;
  return no_such("look", ref, "look");
}

Result<Look> OpenRoom::LooksPart::create(Look look, std::span<const std::uint8_t> picture,
                                         const store::FirstAnswer<Look>& answer) {
  look.model_id = room_.model_id_;
  auto created = STRATA_TRY(room_.services_.store.looks().create(look, picture, answer));
  room_.surface_image_cache_->put(created);
  tell(Listener::LayerChange::created, created);
  return created;
}

Result<Look> OpenRoom::LooksPart::update(const Look& look, const store::FirstAnswer<Look>& answer) {
  auto updated = STRATA_TRY(room_.services_.store.looks().update(look, answer));
  room_.surface_image_cache_->put(updated);
  tell(Listener::LayerChange::changed, updated);
  return updated;
}

Result<void> OpenRoom::LooksPart::erase(std::int64_t id, const store::FirstAnswer<>& answer) {
  const auto known = room_.surface_image_cache_->find(std::to_string(id));
  STRATA_TRY(room_.services_.store.looks().remove(id, answer));
  room_.surface_image_cache_->drop(id);
  if (known) tell(Listener::LayerChange::deleted, *known);
  return {};
}

void OpenRoom::LooksPart::tell(Listener::LayerChange change, const Look& look) {
  run_on(room_.strand_, [&] {
    room_.participants_part_->tell([&](Listener& l) { l.look_changed(change, look); });
  });
  room_.participants_part_->styles_changed();
}

}  // namespace strata::room
