#include "net/formula_layers.h"

#include <algorithm>
#include <tuple>

#include "jobs/shape_layer.h"
#include "net/api/layers/layer_jobs.h"
#include "net/http/answer_book.h"
#include "query/expression_parser.h"
#include "room/await.h"
#include "room/expression_binding.h"

namespace strata::net {
namespace {

// A number or a condition.
bool reads_records_of(const Expression& e, const std::string& layer) {
  return (e.is_column() && e.name == layer) ||
         std::ranges::any_of(e.parts,
                             [&](const Expression& part) { return reads_records_of(part, layer); });
}

std::vector<query::LayerView> views_of(const std::vector<Layer>& layers) {
  std::vector<query::LayerView> views;
  for (const Layer& layer : layers) views.push_back({layer, {}});
  return views;
}

Result<TileMap> shape_tiles(const RouteContext& context, const room::Room& room,
                            const std::string& name, int resolution, Progress& progress) {
  const Model model = room.model();
  for (const auto& [normal, axis] : {std::pair("nx", 0), std::pair("ny", 1), std::pair("nz", 2)})
    if (name == normal) return jobs::paint_normals(room.geometry(), axis, resolution, progress);
  jobs::ShapeRecipe recipe;
  recipe.kind = name == "height"  ? jobs::ShapeKind::height
                : name == "slope" ? jobs::ShapeKind::slope
                                  : jobs::ShapeKind::mean_curvature;
  auto complete = STRATA_TRY(jobs::completed(std::move(recipe), model));
  auto shape = STRATA_TRY(jobs::compute_shape_layer(context.store, model, room.geometry(), complete,
                                                    ValueType::f32, resolution, progress));
  return std::move(shape.tiles);
}

Result<std::vector<query::LayerView>> shape_views(const RouteContext& context,
                                                  const room::Room& room,
                                                  const Expression& expression, int resolution,
                                                  Progress& progress) {
  std::vector<query::LayerView> views;
  for (const std::string& name : room::shapes_read(expression, views_of(room.layers()))) {
    auto tiles = STRATA_TRY(shape_tiles(context, room, name, resolution, progress));
    query::LayerView view;
    view.layer.slug = std::string(room::kShapePrefix) + name;
    view.layer.type = ValueType::f32;
    view.layer.resolution = resolution;
    view.snapshot.tiles = std::move(tiles);
    views.push_back(std::move(view));
  }
  return views;
}

bool is_condition(const Layer& layer) {
  const auto expression =
      layer.formula ? parse_formula(layer.formula->expression) : fail(ErrorCode::invalid, {}, {});
  return expression && expression->is_condition();
}

// Colours over most of the values; those of a condition are as they were made.
Result<Layer> with_colors(room::Room& room, Layer layer) {
  if (is_condition(layer)) return layer;
  const auto values = STRATA_TRY(room.statistics(layer.slug, {}, {.quantiles = true}));
  if (!values.quantiles || !(values.max > values.min)) return layer;
  jobs::ValueRange range{values.min, values.quantiles->front(), values.quantiles->back(),
                         values.max};
  if (!(range.high > range.low))
    std::tie(range.low, range.high) = std::pair(range.least, range.most);
  layer.palette = jobs::palette_of(jobs::ShapeKind::vertex_property, range);
  return room.update_layer(std::move(layer));
}

}  // namespace

Result<Expression> parse_formula(const std::string& text) {
  auto number = query::parse_number(text, "expression");
  if (number) return number;
  auto condition = query::parse_condition(text, "expression");
  return condition ? std::move(condition) : std::move(number);
}

Result<LayerFormula> read_formula(const room::Room& room, const std::string& text, bool automatic,
                                  Visibility visibility, std::optional<std::int64_t> self) {
  const auto expression = STRATA_TRY(parse_formula(text));
  const std::vector<Layer> layers = room.layers();
  const auto shapes = room::shapes_read(expression, views_of(layers));
  LayerFormula formula;
  formula.expression = text;
  formula.automatic = automatic;
  for (const std::string& slug : layers_of(expression)) {
    const auto layer = std::ranges::find(layers, slug, &Layer::slug);
    if (layer == layers.end()) continue;  // of the surface, or nothing: the binding says so
    if (self && layer->id == *self)
      return fail(ErrorCode::invalid, "Computed from itself",
                  "The expression reads the very layer that it is for.", "expression");
    LayerFormula::Input input{slug, layer->id, {}};
    if (reads_records_of(expression, slug)) input.table = layer->table;
    formula.inputs.push_back(std::move(input));
  }
  std::ranges::sort(formula.inputs, {}, &LayerFormula::Input::slug);
  STRATA_TRY(room.check_expression(expression, "expression", visibility));
  return formula;
}

Result<Layer> compute_layer(const RouteContext& context, const std::shared_ptr<room::Room>& room,
                            const Layer& layer, const Author& author, Progress& progress,
                            bool overwrites) {
  if (!layer.formula)
    return fail(ErrorCode::conflict, "No expression",
                "This layer has no expression that it could be computed from.", "layer");
  for (const auto& input : layer.formula->inputs)
    if (!input.layer)
      return fail(ErrorCode::conflict, "Input deleted",
                  "The expression reads the layer '" + input.slug +
                      "', which was deleted. Change the expression.",
                  "expression");
  const auto expression = STRATA_TRY(parse_formula(layer.formula->expression));
  auto shapes = STRATA_TRY(shape_views(context, *room, expression, layer.resolution, progress));
  if (progress.cancelled()) return cancelled_problem();
  // Before the records are read: what changes meanwhile makes the layer stale.
  const auto tables = STRATA_TRY(context.store.table_sequences_of(layer.id));
  room::EditRequest edit{random_uuid(), author, layer.id};
  edit.record = {{"op", "compute"}, {"expression", layer.formula->expression}};
  edit.edit = room::ComputeEdit{expression, std::move(shapes), overwrites};
  auto done = room::await<room::EditAnswer>([&](auto saved) {
    room->edit(
        std::move(edit), [&context](const room::EditAnswer&) { ++context.metrics.edits_applied; },
        std::move(saved));
  });
  if (!done) {
    ++context.metrics.edits_refused;
    return tl::unexpected(done.error());
  }
  ++context.metrics.edits_saved;
  return room->layer_computed(layer.id, layer.formula->expression, done->sequence, tables);
}

Result<Response> create_formula_layer(const RouteContext& context, JobBook& book,
                                      const Request& request,
                                      const std::shared_ptr<room::Room>& room, Layer layer,
                                      bool has_palette,
                                      const std::function<Response(const Layer&)>& answer) {
  const auto expression = STRATA_TRY(parse_formula(layer.formula->expression));
  const auto compute = [&context, room, author = request.author(), has_palette](
                           const Layer& made, Progress& progress) -> Result<Layer> {
    auto computed = compute_layer(context, room, made, author, progress);
    if (!computed) return computed;
    // Others see it once they want to.
    STRATA_TRY(context.store.show_layer_to(author.user, made.model_id, made.id));
    return has_palette ? computed : with_colors(*room, std::move(*computed));
  };
  if (!room::shapes_read(expression, views_of(room->layers())).empty())
    return start_layer_job(context, book, request, room,
                           [layer = std::move(layer), compute](
                               NewLayers& layers, Progress& progress) -> Result<nlohmann::json> {
                             STRATA_TRY(layers.add(layer, [&](const Layer& empty) {
                               return compute(empty, progress);
                             }));
                             return nlohmann::json();
                           });
  NewLayers layers(room, context.metrics, request.author());
  Progress progress;
  Result<void> shown;
  if (auto made = layers.add(std::move(layer),
                             [&](const Layer& empty) { return compute(empty, progress); });
      !made)
    shown = tl::unexpected(made.error());
  else
    shown = layers.show(first_answer<Layer>(request, answer));
  if (!shown) {
    layers.take_back();
    return tl::unexpected(shown.error());
  }
  auto now =
      context.store.layer(room->model().id, std::to_string(layers.ids().front()), Role::owner);
  if (!now) return tl::unexpected(now.error());
  return answer(*now);
}

}  // namespace strata::net
