#include "app/layers/new_layers.h"

#include <algorithm>

#include "core/log.h"
#include "room/edit.h"
#include "room/layers.h"

namespace strata::app {
namespace {

constexpr int kMaxTries = 5;

}  // namespace

Result<Layer> NewLayers::add(Layer layer, const std::function<Result<Layer>(const Layer&)>& fill) {
  const bool visible = layer.visible;
  layer.visible = false;
  auto created =
      room_->layers().create(std::move(layer), {.key = {}, .make = {}, .user = author_.user});
  if (!created) return created;
  made_.push_back({*created, visible});
  return fill(*created);
}

Result<Layer> NewLayers::add(Layer layer, TileMap tiles, nlohmann::json recipe) {
  return add(std::move(layer), [&](const Layer& created) {
    return paint(created, std::move(tiles), std::move(recipe));
  });
}

Result<Layer> NewLayers::paint(const Layer& created, TileMap tiles, nlohmann::json recipe) {
  room::EditRequest edit{random_uuid(), author_, created.id};
  edit.record = {{"op", "import"}, {"recipe", std::move(recipe)}};
  edit.edit = room::ImportEdit{.tiles = std::move(tiles), .computed = true};
  STRATA_TRY(edit_and_wait(*room_, std::move(edit), counters_));
  return created;
}

Result<void> NewLayers::show(const store::IdempotentResponse<Layer>& answer) {
  store::IdempotentResponse<Layer> last = answer;
  last.user.clear();  // the activity lists the creation, so it needs no entry for this update
  for (std::size_t i = 0; i < made_.size(); ++i) {
    const bool is_last = i + 1 == made_.size();
    for (int tries = 0;; ++tries) {
      auto now = STRATA_TRY(room_->layers().find(to_string(made_[i].layer.id)));
      now.visible = made_[i].visible;
      auto shown = room_->layers().update(now, is_last ? last : store::IdempotentResponse<Layer>{});
      if (shown) break;
      // If another user has renamed the layer in the meantime, tries again with the new version.
      if (shown.error().code != ErrorCode::stale || tries == kMaxTries)
        return tl::unexpected(shown.error());
    }
  }
  return {};
}

void NewLayers::take_back() {
  for (const Made& made : made_)
    if (auto gone = room_->layers().erase(made.layer.id);
        !gone && gone.error().code != ErrorCode::not_found && gone.error().code != ErrorCode::gone)
      log::warning("layer " + to_string(made.layer.id) +
                   " of work that failed could not be removed: " + gone.error().detail);
  made_.clear();
}

int order_on_top(const std::vector<Layer>& others) {
  int top = -1;
  for (const Layer& other : others) top = std::max(top, other.order);
  return top + 1;
}

std::vector<LayerId> NewLayers::ids() const {
  std::vector<LayerId> ids;
  for (const Made& made : made_) ids.push_back(made.layer.id);
  return ids;
}

}  // namespace strata::app
