#include "app/layers/analysis.h"

#include <algorithm>
#include <utility>

#include "app/cancellable.h"
#include "app/layers/computed_layers.h"
#include "app/layers/formula_layers.h"
#include "core/overloaded.h"
#include "expression/expression_parser.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/pipeline/expression_binding.h"
#include "room/selection.h"

namespace strata::app {
namespace {

using Compute = AnalysisStep::Compute;
using Measure = AnalysisStep::Measure;

tl::unexpected<Error> slug_taken(const std::string& slug) {
  return fail(ErrorCode::conflict, "Slug already used",
              "The model or an earlier step has a layer with the slug " + slug +
                  ", so the slug would not identify one layer. Choose another name or slug, "
                  "or delete that layer.",
              "name");
}

bool is_called(const Layer& layer, const std::string& ref) {
  return layer.slug == ref || (layer.id != LayerId(0) && to_string(layer.id) == ref);
}

Result<void> check(const room::Room& room, const std::vector<Layer>& layers,
                   const std::vector<Layer>& planned, const Compute& step) {
  if (std::ranges::find(layers, step.layer.slug, &Layer::slug) != layers.end())
    return slug_taken(step.layer.slug);
  if (step.recipe) return {};
  STRATA_TRY(read_formula(room, step.expression, step.automatic, step.layer, planned));
  return {};
}

Result<void> check(const Services& services, Role role, const std::vector<Layer>& layers,
                   const Measure& step) {
  if (std::ranges::none_of(layers,
                           [&](const Layer& layer) { return is_called(layer, step.layer); }))
    return fail(ErrorCode::invalid, "Layer not found",
                "Neither the model nor an earlier step has a layer \"" + step.layer + "\".",
                "layer");
  if (!step.where) return {};
  const auto condition = STRATA_TRY(query::parse_condition(*step.where, "where"));
  std::vector<query::LayerView> views;
  for (const Layer& layer : layers) views.push_back({layer, {}});
  STRATA_TRY(room::bind_expression(condition, views, services.store, role, std::nullopt, "where"));
  return {};
}

std::string_view member_of(const AnalysisStep& step) {
  return std::holds_alternative<Compute>(step.work) ? "layer" : "statistics";
}

// Returns the layers with these slugs that still exist.
std::vector<Layer> inputs_of(const room::Room& room, const std::vector<std::string>& slugs) {
  std::vector<Layer> inputs;
  for (Layer& layer : room.layers().all())
    if (std::ranges::find(slugs, layer.slug) != slugs.end()) inputs.push_back(std::move(layer));
  std::ranges::sort(inputs, {}, &Layer::slug);
  return inputs;
}

Result<AnalysisResult> run(const Services& services, const std::shared_ptr<room::Room>& room,
                           const Compute& step, const LayerAnalysis& origin, const Author& author,
                           NewLayers& layers, Progress& progress) {
  Layer layer = step.layer;
  layer.analysis = origin;
  AnalysisResult result;
  if (step.recipe) {
    result.layer = STRATA_TRY(add_shape_layer(services.store, *room, layers, layer, *step.recipe,
                                              step.has_palette, author.user, progress));
  } else {
    // Reads the expression again, because now the layers of the earlier steps have ids.
    layer.formula = STRATA_TRY(read_formula(*room, step.expression, step.automatic, layer));
    layer.origin = LayerOrigin::expression;
    std::vector<std::string> slugs;
    for (const auto& input : layer.formula->inputs) slugs.push_back(input.slug);
    result.inputs = inputs_of(*room, slugs);
    result.layer = STRATA_TRY(add_formula_layer(services, room, layers, std::move(layer), author,
                                                step.has_palette, progress));
    result.sequence = result.layer.formula->computed_sequence;
  }
  // Another user can have created a layer with this slug in the meantime.
  if (result.layer.slug != step.layer.slug) return slug_taken(step.layer.slug);
  return result;
}

Result<AnalysisResult> run(room::Room& room, const Measure& step, Progress& progress) {
  AnalysisResult result;
  result.layer = STRATA_TRY(room.layers().find(step.layer));
  room::Selection selection;
  std::vector<std::string> slugs;
  if (step.where) {
    selection.where = STRATA_TRY(query::parse_condition(*step.where, "where"));
    slugs = layers_of(*selection.where);
  }
  slugs.push_back(result.layer.slug);
  result.inputs = inputs_of(room, slugs);
  // A state that others can read again, even if edits follow during the computation.
  selection.at = result.sequence = room.edits().durable_sequence();
  progress.report(0, "Measuring the layer");
  result.statistics = STRATA_TRY(cancellable(progress, [&] {
    return room.queries().statistics(result.layer.slug, selection, step.options);
  }));
  return result;
}

}  // namespace

std::vector<Layer> layers_after(const room::Room& room, const Analysis& analysis) {
  std::vector<Layer> layers = room.layers().all();
  for (const AnalysisStep& step : analysis.steps)
    if (const auto* compute = std::get_if<Compute>(&step.work)) layers.push_back(compute->layer);
  return layers;
}

Result<void> add_step(const Services& services, const room::Room& room, Role role,
                      Analysis& analysis, AnalysisStep step) {
  const std::vector<Layer> layers = layers_after(room, analysis);
  std::vector<Layer> planned;
  std::ranges::copy_if(layers, std::back_inserter(planned),
                       [](const Layer& layer) { return layer.id == LayerId(0); });
  STRATA_TRY(std::visit(
      Overloaded{[&](const Compute& compute) { return check(room, layers, planned, compute); },
                 [&](const Measure& measure) { return check(services, role, layers, measure); }},
      step.work));
  analysis.steps.push_back(std::move(step));
  return {};
}

tl::unexpected<Error> at_step(Error problem, std::size_t index, std::string_view member) {
  std::string path = "steps[" + std::to_string(index) + "]." + std::string(member);
  if (!problem.field.empty()) path += "." + problem.field;
  problem.field = std::move(path);
  return tl::unexpected(std::move(problem));
}

Result<std::vector<AnalysisResult>> run_analysis(const Services& services,
                                                 const std::shared_ptr<room::Room>& room,
                                                 const Analysis& analysis, const Author& author,
                                                 NewLayers& layers, Progress& progress) {
  const int count = static_cast<int>(analysis.steps.size());
  std::vector<AnalysisResult> results;
  for (int number = 1; number <= count; ++number) {
    if (progress.cancelled()) return cancelled_problem();
    progress.begin_part(number, count);
    const AnalysisStep& step = analysis.steps[number - 1];
    auto result = std::visit(
        Overloaded{[&](const Compute& compute) {
                     return run(services, room, compute,
                                {analysis.name, number, count, progress.job()}, author, layers,
                                progress);
                   },
                   [&](const Measure& measure) { return run(*room, measure, progress); }},
        step.work);
    if (!result && result.error().code == ErrorCode::cancelled)
      return tl::unexpected(std::move(result.error()));
    if (!result) {
      Error& problem = result.error();
      problem.detail =
          "Step " + std::to_string(number) + " of " + std::to_string(count) + ": " + problem.detail;
      return at_step(std::move(problem), static_cast<std::size_t>(number - 1), member_of(step));
    }
    results.push_back(std::move(*result));
  }
  return results;
}

}  // namespace strata::app
