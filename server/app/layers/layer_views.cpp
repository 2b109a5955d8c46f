#include "app/layers/layer_views.h"

#include <algorithm>

#include "room/layers.h"
#include "room/queries.h"

namespace strata::app {

std::vector<query::LayerView> views_of(const std::vector<Layer>& layers) {
  std::vector<query::LayerView> views;
  for (const Layer& layer : layers) views.push_back({layer, {}});
  return views;
}

Result<std::vector<query::LayerView>> views_read(room::Room& room,
                                                 const std::vector<std::string>& read) {
  std::vector<query::LayerView> views = views_of(room.layers().all());
  for (query::LayerView& view : views)
    if (std::ranges::find(read, view.layer.slug) != read.end())
      view.snapshot = STRATA_TRY(room.queries().tiles(view.layer.slug, {}));
  return views;
}

}  // namespace strata::app
