#include "room/pipeline/expression_binding.h"

#include <algorithm>
#include <map>

#include "core/text/closest.h"
#include "expression/expression_parser.h"
#include "expression/surface_functions.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::room {
namespace {

// The names must not be suggested as names of layers.
static_assert(query::kSurfaceFunctionPrefix.starts_with(kShapePrefix));

// Returns the part where the text first names the layer, for the error message.
const Expression& first_name(const Expression& e) {
  if (e.is_column() || e.parts.empty()) return e;
  const Expression* first = &e;
  for (const Expression& part : e.parts)
    if (const Expression& name = first_name(part); name.position.at <= first->position.at)
      first = &name;
  return *first;
}

bool has_layer(const std::vector<query::LayerView>& layers, const std::string& slug) {
  return std::ranges::find(layers, slug, [](const auto& each) { return each.layer.slug; }) !=
         layers.end();
}

constexpr std::array<std::string_view, 4> kPlaceNames{"x", "y", "z", "area"};

// Returns the names for which `wrong` may be a typing mistake: slugs of `layers` and values of the
// surface. If a layer has a similar name, its slug is returned. `wet-dry` may be a subtraction
// without spaces.
std::vector<std::string> similar_layers(const std::string& wrong,
                                        const std::vector<query::LayerView>& layers) {
  for (auto hyphen = wrong.find('-'); hyphen != std::string::npos;
       hyphen = wrong.find('-', hyphen + 1)) {
    const std::string a = wrong.substr(0, hyphen), b = wrong.substr(hyphen + 1);
    if (has_layer(layers, a) && has_layer(layers, b))
      return {query::name_in_expression(a) + " - " + query::name_in_expression(b)};
  }
  std::vector<std::string> names;
  std::map<std::string, std::string> slug_of;
  for (const query::LayerView& view : layers) {
    if (view.layer.slug.starts_with(kShapePrefix)) continue;
    names.push_back(view.layer.slug);
    if (slug_of.emplace(view.layer.name, view.layer.slug).second) names.push_back(view.layer.name);
  }
  names.insert(names.end(), kPlaceNames.begin(), kPlaceNames.end());
  names.insert(names.end(), kShapeNames.begin(), kShapeNames.end());
  std::vector<std::string> similar;
  for (const std::string& found : closest_names(wrong, names)) {
    const auto named = slug_of.find(found);
    std::string text = query::name_in_expression(named == slug_of.end() ? found : named->second);
    if (std::ranges::find(similar, text) == similar.end()) similar.push_back(std::move(text));
  }
  return similar;
}

// Returns the error for a layer that does not exist.
Error unknown_layer(const std::string& name, Expression::Position position,
                    const std::vector<query::LayerView>& candidates, const std::string& field) {
  return expression_problem("This model has no layer '" + name.substr(0, 100) +
                                "'; use the slug of a layer, and write spaces around a minus sign",
                            position, field, mistake::kUnknownLayer,
                            similar_layers(name, candidates));
}

// Returns the error for columns of a layer that does not exist.
Error no_record_layer(const query::RecordPart& part, const Expression& first,
                      const std::vector<query::LayerView>& candidates, const std::string& field) {
  std::vector<std::string> similar;
  if (first.is_column()) {
    similar = similar_layers(part.layer, candidates);
    for (std::string& name : similar)
      for (const std::string& step : first.path) name += "." + query::name_in_expression(step);
  }
  return expression_problem("This model has no layer '" + part.layer.substr(0, 100) + "'",
                            first.position, field, mistake::kUnknownLayer, std::move(similar));
}

// Puts the name of the layer before each suggested column. The part of an expression that reads
// records contains the path of a column without the layer.
Error with_layer(Error problem, const std::string& slug) {
  if (problem.reason == mistake::kUnknownColumn)
    for (std::string& path : problem.suggestions)
      path = query::name_in_expression(slug) + "." + path;
  return problem;
}

// Replaces the names of surface values by the values. Rejects other names of layers that do not
// exist.
Result<void> name_surface(Expression& e, const std::vector<query::LayerView>& layers,
                          const std::vector<query::LayerView>& candidates,
                          const std::string& field) {
  for (Expression& part : e.parts) STRATA_TRY(name_surface(part, layers, candidates, field));
  if ((e.op != Expression::Op::layer && e.op != Expression::Op::valid) || has_layer(layers, e.name))
    return {};
  using Place = std::pair<std::string_view, Expression::Op>;
  for (const auto& [name, op] :
       {Place{"x", Expression::Op::x}, Place{"y", Expression::Op::y}, Place{"z", Expression::Op::z},
        Place{"area", Expression::Op::area}})
    if (e.name == name) {
      const bool tests_value = e.op == Expression::Op::valid;
      e.op = op;
      e.name.clear();
      if (!tests_value) return {};
      Expression known;
      known.op = Expression::Op::known;
      known.position = e.position;
      known.parts.push_back(std::move(e));
      e = std::move(known);
      return {};
    }
  if (std::ranges::find(kShapeNames, e.name) == kShapeNames.end())
    return tl::unexpected(unknown_layer(e.name, e.position, candidates, field));
  const std::string given = std::string(kShapePrefix) + e.name;
  if (!has_layer(layers, given))
    return tl::unexpected(expression_problem(
        "'" + e.name +
            "' of the surface works in computed layers only: create a computed layer from it "
            "and use that layer here",
        e.position, field, mistake::kComputedLayersOnly));
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
                                               const std::string& field,
                                               const std::vector<query::LayerView>* candidates) {
  const std::vector<query::LayerView>& similar = candidates ? *candidates : layers;
  auto split = STRATA_TRY(query::split_records(expression, field));
  query::BoundExpression bound{std::move(split.expression), {}};
  STRATA_TRY(name_surface(bound.expression, layers, similar, field));
  for (const query::RecordPart& part : split.parts) {
    const auto view =
        std::ranges::find(layers, part.layer, [](const auto& each) { return each.layer.slug; });
    const Expression& first = first_name(part.expression);
    if (view == layers.end()) return tl::unexpected(no_record_layer(part, first, similar, field));
    const Layer& layer = view->layer;
    if (!layer.table)
      return tl::unexpected(expression_problem(
          "'" + layer.slug + "' stores numbers: only layers of records have columns",
          first.position, field, mistake::kWrongType));
    std::optional<std::int64_t> then;
    if (at) {
      auto sequence = STRATA_TRY(store.tables().sequence_when(*layer.table, layer.model_id, *at));
      then = sequence;
    }
    auto numbers = store.records().numbers(*layer.table, seen_by, part.expression, then, field);
    if (!numbers) return tl::unexpected(with_layer(numbers.error(), layer.slug));
    bound.records.emplace_back(*numbers);
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
                             std::nullopt, field, &readable));
  return fail(ErrorCode::invalid, "Visible to too many people",
              "The expression reads layers or columns that fewer people can see than this "
              "layer, which is " +
                  std::string(name(layer)) +
                  ". Restrict the visibility of this layer, or remove those layers and columns "
                  "from the expression.",
              field);
}

}  // namespace strata::room
