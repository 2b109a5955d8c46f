#include "app/authorization/visibility_leak_check.h"

#include <algorithm>
#include <map>
#include <set>

#include "app/layers/formula_layers.h"
#include "expression/expression.h"
#include "store/content/layers.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

tl::unexpected<Error> shows_through(const Layer& layer) {
  return fail(
      ErrorCode::conflict, "Visible to too many people",
      "The layer " + layer.name + " is " + std::string(name(layer.visibility)) +
          " and uses these values in its expression or for its colors, so more people could see "
          "them. First restrict the visibility of that layer, or change its expression or palette.",
      "visibility");
}

// Returns whether the expression reads this column from the records of one of these layers.
bool reads_column(const Expression& e, const std::set<std::string>& layers,
                  const std::string& column) {
  if (e.is_column() && layers.contains(e.name) && !e.path.empty() && e.path.front() == column)
    return true;
  return std::ranges::any_of(
      e.parts, [&](const Expression& part) { return reads_column(part, layers, column); });
}

bool names_unseen_column(const Expression& e, const std::map<std::string, Table>& seen,
                         const std::map<std::string, Table>& all) {
  if (e.is_column() && !e.path.empty())
    if (const auto table = all.find(e.name); table != all.end())
      if (find_column(table->second.columns, e.path.front()) &&
          !find_column(seen.at(e.name).columns, e.path.front()))
        return true;
  return std::ranges::any_of(
      e.parts, [&](const Expression& part) { return names_unseen_column(part, seen, all); });
}

}  // namespace

Result<void> check_shows_nothing(store::Store& store, const Layer& layer,
                                 const std::vector<Layer>& others) {
  if (layer.table && !layer.palette.column.empty()) {
    const auto table = STRATA_TRY(store.tables().find(to_string(*layer.table), Role::owner));
    const Column* column = find_column(table.columns, layer.palette.column);
    if (column && column->visibility > layer.visibility)
      return fail(ErrorCode::invalid, "Visible to too many people",
                  "The palette takes its colors from the column " + column->name + ", which is " +
                      std::string(name(column->visibility)) +
                      ", but more people can see the layer than the column. Restrict the "
                      "visibility of the layer, or choose another column for its colors.",
                  "palette.column");
  }
  for (const Layer& other : others)
    if (other.formula && other.visibility < layer.visibility &&
        std::ranges::any_of(other.formula->inputs,
                            [&](const auto& input) { return input.layer == layer.id; }))
      return shows_through(other);
  return {};
}

Result<void> check_shows_nothing(store::Store& store, const Table& table, const Column& column,
                                 Visibility visibility) {
  const auto layers = STRATA_TRY(store.layers().of_table(table.id, Role::owner));
  std::map<ModelId, std::set<std::string>> by_model;  // slugs of layers
  for (const Layer& layer : layers) {
    by_model[layer.model_id].insert(layer.slug);
    if (layer.visibility < visibility &&
        find_column(table.columns, layer.palette.column) == &column)
      return shows_through(layer);
  }
  for (const auto& [model, slugs] : by_model) {
    const auto all = STRATA_TRY(store.layers().of_model(model, Role::owner));
    for (const Layer& layer : all) {
      if (!layer.formula || layer.visibility >= visibility) continue;
      const auto expression = parse_formula(layer.formula->expression);
      if (expression && reads_column(*expression, slugs, column.slug)) return shows_through(layer);
    }
  }
  return {};
}

Result<void> check_all_may_see(const Layer& source, const Layer& painted,
                               const std::string& field) {
  if (source.visibility <= painted.visibility) return {};
  return fail(ErrorCode::invalid, "Layer is hidden from some users",
              "Fewer users see " + source.name + " than " + painted.name +
                  ". Choose a layer with the same visibility.",
              field);
}

Result<bool> sees_all_of(store::Store& store, Role role, ModelId model_id,
                         const std::string& text) {
  if (sees(role, Visibility::curators)) return true;
  const auto expression = parse_formula(text);
  if (!expression) return false;
  const auto layers = STRATA_TRY(store.layers().of_model(model_id, Role::owner));
  const std::vector<std::string> named = layers_of(*expression);
  std::map<std::string, Table> seen, all;  // by layer slug
  for (const Layer& layer : layers) {
    if (std::ranges::find(named, layer.slug) == named.end()) continue;
    if (!sees(role, layer.visibility)) return false;
    if (!layer.table) continue;
    auto table = STRATA_TRY(store.tables().find(to_string(*layer.table), Role::owner));
    seen.emplace(layer.slug, seen_by(table, role));
    all.emplace(layer.slug, std::move(table));
  }
  return !names_unseen_column(*expression, seen, all);
}

}  // namespace strata::app
