#include "app/layers/formula_layers.h"

#include <algorithm>
#include <tuple>

#include "app/edits.h"
#include "app/layers/formula_limits.h"
#include "app/layers/layer_views.h"
#include "app/layers/prepared_formula.h"
#include "domain/layers/layer.h"
#include "domain/layers/tile_mirror.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/scene/model_measures.h"
#include "expression/expression_parser.h"
#include "jobs/shape_layer.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/pipeline/expression_binding.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/surface.h"
#include "store/content/layers.h"
#include "store/people/personal_views.h"
#include "store/store.h"

namespace strata::app {
namespace {

// Returns whether `e` reads records of this layer.
bool reads_records_of(const Expression& e, const std::string& layer) {
  return (e.is_column() && e.name == layer) ||
         std::ranges::any_of(e.parts,
                             [&](const Expression& part) { return reads_records_of(part, layer); });
}

// Returns the sequence of the state that the computed values belong to. Functions along the surface
// read an earlier state than the edit, if there were edits between.
std::int64_t computed_sequence(const PreparedFormula& formula, const room::EditAnswer& done) {
  const std::int64_t read = formula.sequence.value_or(done.sequence);
  return read + 1 < done.sequence ? read : done.sequence;
}

// The area of a condition, and classes, keep their colors.
bool keeps_palette(const Layer& layer) { return layer.palette.mode == PaletteMode::categorical; }

Result<Layer> with_colors(room::Room& room, Layer layer) {
  if (keeps_palette(layer)) return layer;
  const auto values = STRATA_TRY(room.queries().statistics(layer.slug, {}, {.quantiles = true}));
  auto palette = palette_of_values(layer, values);
  if (!palette) return layer;
  layer.palette = std::move(*palette);
  return room.layers().update(std::move(layer));
}

}  // namespace

Result<Expression> parse_formula(const std::string& text) {
  auto number = query::parse_number(text, "expression");
  if (number) return number;
  auto condition = query::parse_condition(text, "expression");
  return condition ? std::move(condition) : std::move(number);
}

std::optional<Palette> palette_of_values(const Layer& layer, const query::Statistics& values) {
  if (keeps_palette(layer) || !values.quantiles || !(values.max > values.min)) return std::nullopt;
  jobs::ValueRange range{values.min, values.quantiles->front(), values.quantiles->back(),
                         values.max};
  if (!(range.high > range.low))
    std::tie(range.low, range.high) = std::pair(range.least, range.most);
  return jobs::palette_of(jobs::ShapeKind::vertex_property, range);
}

Result<LayerFormula> read_formula(const room::Room& room, const std::string& text, bool automatic,
                                  const Layer& computed, const std::vector<Layer>& planned) {
  const auto expression = STRATA_TRY(parse_formula(text));
  const std::vector<Layer> layers = room.layers().all();
  LayerFormula formula;
  formula.expression = text;
  formula.automatic = automatic;
  for (const std::string& slug : layers_of(expression)) {
    const auto layer = std::ranges::find(layers, slug, &Layer::slug);
    if (layer == layers.end()) continue;  // `check_expression` checks all other names
    if (layer->id == computed.id)
      return fail(ErrorCode::invalid, "Layer depends on itself",
                  "The expression uses the layer that it computes. Remove this layer from the "
                  "expression.",
                  "expression");
    LayerFormula::Input input{slug, layer->id, {}};
    if (reads_records_of(expression, slug)) input.table = layer->table;
    formula.inputs.push_back(std::move(input));
  }
  std::ranges::sort(formula.inputs, {}, &LayerFormula::Input::slug);
  STRATA_TRY(
      room.layers().check_expression(expression, "expression", computed.visibility, planned));
  STRATA_TRY(check_formula_limits(expression, room.model(), computed.resolution));
  return formula;
}

Result<Layer> compute_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                            const Layer& layer, const Author& author, Progress& progress,
                            bool overwrites) {
  if (!layer.formula)
    return fail(ErrorCode::conflict, "No expression",
                "This layer has no expression, so the server cannot compute it. Set an "
                "expression first.",
                "layer");
  for (const auto& input : layer.formula->inputs)
    if (!input.layer)
      return fail(ErrorCode::conflict, "Input deleted",
                  "The expression uses the layer '" + input.slug +
                      "', which was deleted. Change the expression.",
                  "expression");
  // Reads the sequences before the records. If the records change later, the layer is then out of
  // date.
  const auto tables = STRATA_TRY(services.store.layers().table_sequences_of(layer.id));
  const Model before = room->model();
  auto formula = STRATA_TRY(prepare_formula(services, *room, layer, author, progress));
  if (progress.cancelled()) return cancelled_problem();
  room::EditRequest edit{random_uuid(), author, layer.id};
  edit.record = {{"op", "compute"}, {"expression", layer.formula->expression}};
  edit.edit = room::ComputeEdit{formula.expression, std::move(formula.views), overwrites};
  const auto done = STRATA_TRY(edit_and_wait(*room, std::move(edit), services.edits));
  // The layer stays stale if its values have become wrong in the meantime (Models::update).
  if (!same_measures(room->model(), before)) return room->layers().find(to_string(layer.id));
  return room->layers().mark_computed(layer.id, layer.formula->expression,
                                      computed_sequence(formula, done), tables);
}

bool reads_shape(const room::Room& room, const Expression& expression) {
  return has_surface_function(expression) ||
         !room::shapes_read(expression, views_of(room.layers().all())).empty();
}

Result<Layer> add_formula_layer(const Services& services, const std::shared_ptr<room::Room>& room,
                                NewLayers& layers, Layer layer, const Author& author,
                                bool has_palette, Progress& progress) {
  return layers.add(std::move(layer), [&](const Layer& made) -> Result<Layer> {
    auto computed = STRATA_TRY(compute_layer(services, room, made, author, progress));
    // The layer is hidden by default. Shows it to its author.
    STRATA_TRY(services.store.personal_views().show_layer_to(author.user, made.model_id, made.id));
    return has_palette ? Result<Layer>(std::move(computed))
                       : with_colors(*room, std::move(computed));
  });
}

}  // namespace strata::app
