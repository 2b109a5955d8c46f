#include "query/maps/plane_raster.h"

#include "domain/layers/texel_lookup.h"
#include "domain/people/question.h"
#include "mesh/parallel.h"

namespace strata::query {

PlaneView::PlaneView(const mesh::SearchTree& tree, const glm::dvec3& origin,
                     const OutlinePlane& plane, bool looks_up, const glm::dvec3& low,
                     const glm::dvec3& high)
    : tree_(tree), origin_(origin), plane_(plane) {
  // Rays begin a little outside the model, so rounding cannot put the start behind the surface.
  const double margin = 1e-3 * glm::distance(low, high);
  start_ = looks_up ? low[plane.depth] - margin : high[plane.depth] + margin;
  direction_[plane.depth] = looks_up ? 1 : -1;
}

std::optional<mesh::SearchTree::Hit> PlaneView::first_hit(const glm::dvec2& place) const {
  glm::dvec3 from;
  from[plane_.right] = place.x;
  from[plane_.up] = place.y;
  from[plane_.depth] = start_;
  return tree_.first_hit(glm::vec3(from - origin_), direction_);
}

std::vector<PlaneRaster> resample(const PlaneView& view, std::span<const LayerView> layers,
                                  const PlaneGrid& grid,
                                  const std::function<bool(const glm::dvec2&)>& is_inside) {
  const auto width = static_cast<std::size_t>(grid.width);
  const std::size_t cells = width * static_cast<std::size_t>(grid.height);
  if (Question* question = Question::current()) question->spend(cells * (1 + layers.size()));
  std::vector<PlaneRaster> rasters;
  for (const LayerView& layer : layers)
    rasters.push_back({grid.width, grid.height, layer.layer.type, std::vector<std::uint32_t>(cells),
                       std::vector<std::uint8_t>(cells)});
  mesh::parallel_for(mesh::background_threads(), grid.height, [&](int row) {
    for (int column = 0; column < grid.width; ++column) {
      const glm::dvec2 center = grid.center_of(column, row);
      if (is_inside && !is_inside(center)) continue;
      const auto hit = view.first_hit(center);
      if (!hit) continue;
      const std::size_t cell = static_cast<std::size_t>(row) * width + std::size_t(column);
      for (std::size_t i = 0; i < layers.size(); ++i) {
        const auto bits = bits_at(layers[i].snapshot.tiles, layers[i].layer.resolution, hit->uv);
        if (!bits) continue;
        rasters[i].bits[cell] = *bits;
        rasters[i].valid[cell] = 1;
      }
    }
  });
  return rasters;
}

}  // namespace strata::query
