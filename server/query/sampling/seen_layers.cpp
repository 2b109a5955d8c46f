#include "query/sampling/seen_layers.h"

#include <mutex>

#include "domain/scene/camera.h"
#include "mesh/parallel.h"
#include "mesh/surface/search_tree.h"

namespace strata::query {

std::vector<SeenLayer> seen_layers(const mesh::SearchTree& tree, const glm::dvec3& origin,
                                   const Camera& camera, int columns, int rows,
                                   const std::vector<LayerView>& layers,
                                   const std::vector<LayerCover>& covers) {
  std::vector<SeenLayer> all(layers.size());
  std::mutex mutex;
  mesh::parallel_for(mesh::background_threads(), rows, [&](int row) {
    std::vector<SeenLayer> seen(layers.size());
    for (int column = 0; column < columns; ++column) {
      const auto point = pick(tree, origin, camera, (column + 0.5) * camera.width / columns,
                              (row + 0.5) * camera.height / rows, {});
      if (point.hit) see_point(point.uv, layers, covers, seen);
    }
    std::lock_guard lock(mutex);
    merge(all, std::move(seen));
  });
  return all;
}

void see_point(glm::vec2 uv, const std::vector<LayerView>& layers,
               const std::vector<LayerCover>& covers, std::vector<SeenLayer>& seen) {
  for (std::size_t i = layers.size(); i-- > 0;) {  // from the top
    const LayerValue value = value_at(layers[i], uv);
    if (!value.valid) continue;
    const Cover cover = covers[i].of(value.value);
    if (cover == Cover::nothing) continue;
    seen[i].is_seen = true;
    if (covers[i].tells_values) seen[i].values.insert(value.value);
    if (cover == Cover::all) break;
  }
}

void merge(std::vector<SeenLayer>& all, std::vector<SeenLayer>&& seen) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].is_seen |= seen[i].is_seen;
    all[i].values.merge(seen[i].values);
  }
}

}  // namespace strata::query
