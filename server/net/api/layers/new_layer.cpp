#include "net/api/layers/new_layer.h"

#include <algorithm>

#include "app/layers/formula_layers.h"
#include "app/layers/new_layers.h"
#include "core/text/ascii.h"
#include "domain/layers/palette.h"
#include "domain/scene/model.h"
#include "jobs/shape_recipe.h"
#include "net/api/route_help.h"

namespace strata::net {
namespace {

// Returns the layer whose values the expression cleans up or continues, such as
// `majority(materials, 5)`, or null. Its type, its unit and its classes are those of the result.
const Layer* source_of_values(const Expression& expression, const std::vector<Layer>& others) {
  if (expression.chooses_value()) return source_of_values(expression.parts.front(), others);
  if (expression.op != Expression::Op::layer) return nullptr;
  const auto found = std::ranges::find(others, expression.name, &Layer::slug);
  return found != others.end() && found->kind == LayerKind::numeric ? &*found : nullptr;
}

Result<Palette> palette_of(const std::optional<nlohmann::json>& requested, ValueType type,
                           bool categorical) {
  if (!requested) return default_palette(type, categorical);
  return palette_from_json(*requested);
}

// Returns a palette with one class, for the texels where the condition is true.
Palette palette_of_condition(const std::string& label) {
  Palette palette;
  palette.mode = PaletteMode::categorical;
  palette.min = palette.max = 1;
  palette.points.push_back({1, {213, 94, 0, 255}, label});
  return palette;
}

int order_at_bottom(const std::vector<Layer>& others) {
  int bottom = 1;
  for (const Layer& other : others) bottom = std::min(bottom, other.order);
  return bottom - 1;
}

}  // namespace

bool is_automatic(const std::optional<protocol::Recompute>& recompute) {
  return recompute == protocol::Recompute::automatic;
}

std::optional<std::string> group_of(const std::string& text) {
  const std::string group(trimmed(text));
  return group.empty() ? std::nullopt : std::optional(group);
}

Result<Layer> new_layer(const protocol::LayerCreate& body, const Model& model,
                        const std::vector<Layer>& others) {
  if ((body.compute || body.expression) && body.kind != LayerKind::numeric)
    return fail(ErrorCode::invalid, "Invalid kind of layer", "A computed layer must be numeric.",
                "kind");
  if (body.compute && body.expression)
    return fail(ErrorCode::invalid, "Too many parameters",
                "Send either `compute` or `expression`, but not both.", "expression");
  if (body.recompute && !body.expression)
    return fail(ErrorCode::invalid, "No expression",
                "Only layers with an `expression` can have `recompute`.", "recompute");
  Layer layer;
  layer.model_id = model.id;
  layer.name = body.name;
  auto slug = STRATA_TRY(slug_of(body.slug, body.name));
  layer.slug = slug;
  layer.kind = body.kind;
  std::optional<Expression> formula;  // none also for a mistake, which read_formula refuses
  if (body.expression)
    if (auto parsed = app::parse_formula(*body.expression)) formula = std::move(*parsed);
  const bool is_condition = formula && formula->is_condition();
  const bool computes_numbers =
      body.expression
          ? !is_condition
          : body.compute &&
                !jobs::has_classes(*jobs::parse_shape_kind(protocol::name(body.compute->kind)));
  const Layer* source =
      formula && formula->chooses_value() ? source_of_values(*formula, others) : nullptr;
  layer.type = body.type.value_or(source             ? source->type
                                  : computes_numbers ? ValueType::f32
                                                     : ValueType::u8);
  const bool is_key =
      layer.type == ValueType::u8 || layer.type == ValueType::u16 || layer.type == ValueType::u32;
  if (layer.kind == LayerKind::database && !is_key)
    return fail(ErrorCode::invalid, "Invalid type of layer",
                "A layer of records stores keys. Its type must be u8, u16 or u32.", "type");
  if ((body.table || body.columns) && layer.kind != LayerKind::database)
    return fail(ErrorCode::invalid, "Table on a numeric layer",
                "Only layers of records can have a table.", body.table ? "table" : "columns");
  if (body.table && body.columns)
    return fail(ErrorCode::invalid, "Table and columns together",
                "Send either an existing table or the columns of a new table, but not both.",
                "columns");
  layer.resolution =
      body.resolution.value_or(std::max(model.default_resolution, model.atlas.lowest_resolution));
  if (layer.resolution < model.atlas.lowest_resolution)
    return fail(ErrorCode::invalid, "Resolution too low",
                "Layers of this model must have at least " +
                    std::to_string(model.atlas.lowest_resolution) + " texels on each side.",
                "resolution");
  layer.unit = body.unit.empty() && source ? source->unit : body.unit;
  layer.description = body.description;
  layer.labels = body.labels.value_or(Labels());
  layer.descriptions = body.descriptions.value_or(Labels());
  layer.group = group_of(body.group.value_or(""));
  const bool is_computed = body.compute || body.expression;
  if (is_computed && body.locked == false)
    return fail(ErrorCode::invalid, "Lock not allowed",
                "The server locks computed layers when it creates them. Unlock the layer "
                "afterwards to edit it by hand.",
                "locked");
  auto palette =
      STRATA_TRY(is_condition && !body.palette
                     ? Result<Palette>(palette_of_condition(body.name))
                     : palette_of(body.palette, layer.type, layer.kind == LayerKind::database));
  if (source && !body.palette)
    layer.palette = source->palette;
  else
    layer.palette = std::move(palette);
  layer.opacity = body.opacity;
  layer.blend = body.blend.value_or(LayerBlend::normal);
  // By default, a computed layer must not cover the layers that other users work with.
  layer.visible = body.visible.value_or(!is_computed);
  layer.locked = body.locked.value_or(is_computed);
  layer.review = body.review;
  layer.visibility = body.visibility.value_or(Visibility::everyone);
  layer.order =
      body.order.value_or(is_computed ? order_at_bottom(others) : app::order_on_top(others));
  return layer;
}

}  // namespace strata::net
