#include "app/layers/layer_preview.h"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <utility>

#include "app/layers/computed_layers.h"
#include "app/layers/formula_layers.h"
#include "app/layers/layer_views.h"
#include "app/layers/prepared_formula.h"
#include "domain/scene/model.h"
#include "mesh/parallel.h"
#include "mesh/surface/geometry.h"
#include "mesh/texels/surface_map.h"
#include "query/conditions/expression_evaluator.h"
#include "query/sampling/values.h"
#include "room/pipeline/expression_binding.h"
#include "room/surface.h"

namespace strata::app {
namespace {

// Returns the values of a formula, as an edit would paint them.
Result<TileMap> formula_content(const Services& services, room::Room& room, const Layer& layer,
                                const mesh::SurfaceMap& map, const Author& author,
                                Progress& progress) {
  auto formula = STRATA_TRY(prepare_formula(services, room, layer, author, progress));
  auto views = STRATA_TRY(views_read(room, layers_of(formula.expression)));
  std::ranges::move(formula.views, std::back_inserter(views));
  const auto bound = STRATA_TRY(room::bind_for_layer(formula.expression, views, services.store,
                                                     author.role, layer.visibility, "expression"));
  return query::compute_tiles(bound.expression, bound.layers, map,
                              {room.surface().geometry()->origin, room.model().metres()},
                              layer.type, "expression", mesh::background_threads());
}

// Values from the shape need memory for the mesh, for other models and for source files, which
// nothing counts. So one preview at a time computes them, and the others wait.
Result<std::unique_lock<std::timed_mutex>> wait_for_shapes(Progress& progress) {
  static std::timed_mutex shapes;
  std::unique_lock lock(shapes, std::defer_lock);
  while (!lock.try_lock_for(std::chrono::milliseconds(100)))
    if (progress.cancelled()) return cancelled_problem();
  return lock;
}

}  // namespace

Result<LayerPreview> preview_layer(const Services& services, room::Room& room, Layer layer,
                                   const std::optional<jobs::ShapeRecipe>& recipe, bool has_palette,
                                   const Author& author, const room::SeenGrid& grid,
                                   Progress& progress) {
  const Model model = room.model();
  layer.resolution =
      std::min(layer.resolution, std::max(kPreviewResolution, model.atlas.lowest_resolution));
  const auto map = STRATA_TRY(room.surface().map(layer.resolution));
  LayerPreview preview;
  preview.layer = std::move(layer);
  query::LayerView view;
  if (recipe) {
    const auto alone = STRATA_TRY(wait_for_shapes(progress));
    auto content =
        STRATA_TRY(shape_content(services.store, room, *recipe, preview.layer, progress));
    if (preview.layer.unit.empty()) preview.layer.unit = std::move(content.unit);
    if (!has_palette) preview.layer.palette = std::move(content.palette);
    view.snapshot.tiles = std::move(content.tiles);
  } else {
    view.snapshot.tiles =
        STRATA_TRY(formula_content(services, room, preview.layer, *map, author, progress));
  }
  view.layer = preview.layer;
  const auto geometry = room.surface().geometry();
  query::StatisticsRequest request;
  request.quantiles = true;
  request.threads = mesh::background_threads();
  preview.statistics = query::statistics(view, *map, geometry->origin, model.metres(), request);
  if (preview.layer.formula && !has_palette)
    if (auto fitted = palette_of_values(preview.layer, preview.statistics))
      preview.layer.palette = std::move(*fitted);
  view.layer.palette = preview.layer.palette;
  const double whole_m2 = map->area_total * model.metres() * model.metres();
  if (whole_m2 > 0) preview.share = std::min(1.0, preview.statistics.area_m2 / whole_m2);
  preview.rgba = query::picture_of_values(*room.surface().search_tree(), geometry->origin,
                                          grid.camera, grid.columns, grid.rows, view);
  return preview;
}

}  // namespace strata::app
