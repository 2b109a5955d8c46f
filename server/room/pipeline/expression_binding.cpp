#include "room/pipeline/expression_binding.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

#include <algorithm>

namespace strata::room {
namespace {

// Returns the position where the text names the layer, for the message.
std::size_t first_character(const Expression& e) {
  if (e.is_column() || e.parts.empty()) return e.position.at;
  std::size_t first = e.position.at;
  for (const Expression& part : e.parts) first = std::min(first, first_character(part));
  return first;
}

bool has_layer(const std::vector<query::LayerView>& layers, const std::string& slug) {
  return std::ranges::find(layers, slug, [](const auto& each) { return each.layer.slug; }) !=
         layers.end();
}

// Replaces names of layers that do not exist by the names of the surface.
Result<void> name_surface(Expression& e, const std::vector<query::LayerView>& layers,
                          const std::string& field) {
  for (Expression& part : e.parts) STRATA_TRY(name_surface(part, layers, field));
  if ((e.op != Expression::Op::layer && e.op != Expression::Op::valid) || has_layer(layers, e.name))
    return {};
  using Place = std::pair<std::string_view, Expression::Op>;
  for (const auto& [name, op] :
       {Place{"x", Expression::Op::x}, Place{"y", Expression::Op::y}, Place{"z", Expression::Op::z},
        Place{"area", Expression::Op::area}})
    if (e.name == name) {
      e.op = op;
      e.name.clear();
      return {};
    }
  if (std::ranges::find(kShapeNames, e.name) == kShapeNames.end())
    return tl::unexpected(
        expression_problem("This model has no layer '" + e.name.substr(0, 100) +
                               "'; use the slug of a layer, and write spaces around a minus sign",
                           e.position.at, field));
  const std::string given = std::string(kShapePrefix) + e.name;
  if (!has_layer(layers, given))
    return tl::unexpected(expression_problem(
        "'" + e.name +
            "' of the surface works in computed layers only: create a computed layer from it "
            "and use that layer here",
        e.position.at, field));
  e.name = given;
  return {};
}

}  // namespace

std::vector<std::string> shapes_read(const Expression& expression,
                                     const std::vector<query::LayerView>& layers) {
  std::vector<std::string> shapes;
  for (const std::string& name : layers_of(expression))
    if (std::ranges::find(kShapeNames, name) != kShapeNames.end() && !has_layer(layers, name))
      shapes.push_back(name);
  return shapes;
}

std::vector<query::LayerView> layers_seen_by(const std::vector<query::LayerView>& layers,
                                             Role role) {
  std::vector<query::LayerView> seen;
  std::ranges::copy_if(layers, std::back_inserter(seen), [role](const query::LayerView& view) {
    return sees(role, view.layer.visibility);
  });
  return seen;
}

Result<query::BoundExpression> bind_expression(const Expression& expression,
                                               const std::vector<query::LayerView>& layers,
                                               store::Store& store, Role seen_by,
                                               std::optional<std::int64_t> at,
                                               const std::string& field) {
  auto split = STRATA_TRY(query::split_records(expression, field));
  query::BoundExpression bound{std::move(split.expression), {}};
  STRATA_TRY(name_surface(bound.expression, layers, field));
  for (const query::RecordPart& part : split.parts) {
    const auto view =
        std::ranges::find(layers, part.layer, [](const auto& each) { return each.layer.slug; });
    const std::size_t character = first_character(part.expression);
    if (view == layers.end())
      return tl::unexpected(expression_problem(
          "This model has no layer '" + part.layer.substr(0, 100) + "'", character, field));
    const Layer& layer = view->layer;
    if (!layer.table)
      return tl::unexpected(expression_problem(
          "'" + layer.slug + "' stores numbers: only layers of records have columns", character,
          field));
    std::optional<std::int64_t> then;
    if (at) {
      auto sequence = STRATA_TRY(store.tables().sequence_when(*layer.table, layer.model_id, *at));
      then = sequence;
    }
    auto numbers =
        STRATA_TRY(store.records().numbers(*layer.table, seen_by, part.expression, then, field));
    bound.records.emplace_back(numbers);
  }
  return bound;
}

Result<BoundForLayer> bind_for_layer(const Expression& expression,
                                     const std::vector<query::LayerView>& layers,
                                     store::Store& store, Role author, Visibility layer,
                                     const std::string& field) {
  const Role reader = least_role(layer);
  std::vector<query::LayerView> readable = layers_seen_by(layers, reader);
  auto bound = bind_expression(expression, readable, store, reader, std::nullopt, field);
  if (bound) return BoundForLayer{std::move(*bound), std::move(readable)};
  if (sight_of(author) == layer) return tl::unexpected(bound.error());
  STRATA_TRY(bind_expression(expression, layers_seen_by(layers, author), store, author,
                             std::nullopt, field));
  return fail(ErrorCode::invalid, "Visible to too many people",
              "The expression reads layers or columns that fewer people can see than this "
              "layer, which is " +
                  std::string(name(layer)) +
                  ". Restrict the visibility of this layer, or remove those layers and columns "
                  "from the expression.",
              field);
}

}  // namespace strata::room
