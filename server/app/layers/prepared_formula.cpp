#include "app/layers/prepared_formula.h"

#include <string>
#include <utility>

#include "app/layers/formula_layers.h"
#include "app/layers/layer_views.h"
#include "app/layers/surface_functions.h"
#include "domain/scene/model.h"
#include "jobs/shape_layer.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/pipeline/expression_binding.h"
#include "room/surface.h"

namespace strata::app {
namespace {

Result<TileMap> shape_tiles(store::Store& store, const room::Room& room, const std::string& name,
                            int resolution, Progress& progress) {
  const Model model = room.model();
  for (const auto& [normal, axis] : {std::pair("nx", 0), std::pair("ny", 1), std::pair("nz", 2)})
    if (name == normal)
      return jobs::paint_normals(room.surface().geometry(), axis, resolution, progress);
  jobs::ShapeRecipe recipe;
  recipe.kind = name == "height"  ? jobs::ShapeKind::height
                : name == "slope" ? jobs::ShapeKind::slope
                                  : jobs::ShapeKind::mean_curvature;
  auto complete = STRATA_TRY(jobs::completed(std::move(recipe), model));
  auto shape = STRATA_TRY(jobs::compute_shape_layer(
      store, model, room.surface().geometry(), complete, ValueType::f32, resolution, progress));
  return std::move(shape.tiles);
}

Result<query::LayerView> shape_view(store::Store& store, const room::Room& room,
                                    const std::string& name, int resolution, Progress& progress) {
  auto tiles = STRATA_TRY(shape_tiles(store, room, name, resolution, progress));
  query::LayerView view;
  view.layer.slug = std::string(room::kShapePrefix) + name;
  view.layer.type = ValueType::f32;
  view.layer.resolution = resolution;
  view.snapshot.tiles = std::move(tiles);
  return view;
}

}  // namespace

Result<PreparedFormula> prepare_formula(const Services& services, room::Room& room,
                                        const Layer& layer, const Author& author,
                                        Progress& progress) {
  const auto expression = STRATA_TRY(parse_formula(layer.formula->expression));
  auto formula = STRATA_TRY(query::separate_surface_functions(expression, "expression"));
  const auto shapes = room::shapes_read(expression, views_of(room.layers().all()));
  const std::size_t steps = shapes.size() + formula.functions.size();
  PreparedFormula prepared;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    progress.begin_stage(double(i) / double(steps), double(i + 1) / double(steps));
    prepared.views.push_back(
        STRATA_TRY(shape_view(services.store, room, shapes[i], layer.resolution, progress)));
  }
  if (!formula.functions.empty()) {
    prepared.memory = STRATA_TRY(reserve_surface_functions(services, room, layer, formula));
    // Read first: if a layer changes afterwards, the result is out of date. The functions read the
    // applied edits. The journal writes these edits before the edit that paints the result.
    prepared.sequence = room.edits().sequence();
    STRATA_TRY(compute_surface_functions(services, room, layer, formula, author, prepared.views,
                                         progress, shapes.size(), steps));
  }
  prepared.expression = std::move(formula.expression);
  return prepared;
}

}  // namespace strata::app
