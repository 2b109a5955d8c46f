#include "app/layers/survey_statistics.h"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "app/figures/class_names.h"
#include "app/records/readable_area.h"
#include "domain/people/question.h"
#include "domain/scene/model.h"
#include "query/statistics/quantiles.h"
#include "query/statistics/quantities.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::app {
namespace {

bool gone_meanwhile(const Error& error) { return error.code == ErrorCode::not_found; }

// Collects the classes of all surveys until they have too many different names.
class ClassCollector {
 public:
  ClassCollector(store::Store& store, const SurveyStatisticsRequest& request)
      : store_(store), request_(request) {}

  // Moves the classes out of the statistics. `of_layer` gets none if there are too many.
  Result<void> collect(SurveyLayer& of_layer) {
    auto keys = std::exchange(of_layer.statistics.keys, {});
    if (too_many_ || !holds_classes(of_layer.layer)) return {};
    // The statistics of a layer with very many values have no keys.
    too_many_ = keys.size() > kMaxSurveyClasses || (keys.empty() && of_layer.statistics.texels > 0);
    if (too_many_) return {};
    std::vector<double> values;
    for (const auto& [key, sums] : keys) values.push_back(key);
    auto names = STRATA_TRY(class_names(store_, of_layer.layer, request_.seen_by, values,
                                        std::nullopt, request_.language));
    names_.insert(names.begin(), names.end());
    too_many_ = names_.size() > kMaxSurveyClasses;
    std::vector<SurveyClass> classes;
    std::size_t at = 0;
    for (const auto& [key, sums] : keys)
      classes.push_back({static_cast<std::int64_t>(key), std::move(names[at++]), sums.texels,
                         sums.area_m2, sums.pieces, sums.perimeter_m});
    of_layer.classes = std::move(classes);
    return {};
  }
  bool too_many() const { return too_many_; }

 private:
  store::Store& store_;
  const SurveyStatisticsRequest& request_;
  std::set<std::string> names_;
  bool too_many_ = false;
};

// Returns nothing if the layer was deleted or hidden in the meantime.
Result<std::optional<SurveyLayer>> count_layer(const Services& services, const Model& model,
                                               const Layer& layer,
                                               const SurveyStatisticsRequest& request) {
  SurveyLayer counted{layer, model.sequence, model.area_m2(), {}};
  if (layer.sequence == 0) {  // never painted
    if (request.options.pieces) counted.statistics.pieces = 0;
    if (request.options.perimeter) counted.statistics.perimeter_m = 0;
    return counted;
  }
  const auto room = STRATA_TRY(services.rooms.open_to_read(to_string(model.id), request.seen_by));
  const auto found = room->layers().find(to_string(layer.id));
  if (!found) return std::nullopt;
  counted.sequence = room->edits().sequence();
  auto statistics = room->queries().statistics(found->slug, {}, request.options);
  if (!statistics && gone_meanwhile(statistics.error())) return std::nullopt;
  if (!statistics) return tl::unexpected(statistics.error());
  counted.statistics = std::move(*statistics);
  counted.statistics.histogram = {};
  return counted;
}

// Returns nothing if the model was deleted in the meantime.
Result<std::optional<SurveyStatistics>> count_survey(const Services& services, const Survey& survey,
                                                     const SurveyStatisticsRequest& request) {
  const auto model = services.store.models().find(to_string(survey.model));
  if (!model && gone_meanwhile(model.error())) return std::nullopt;
  if (!model) return tl::unexpected(model.error());
  const auto layers = services.store.layers().of_model(model->id, request.seen_by);
  if (!layers && gone_meanwhile(layers.error())) return std::nullopt;
  if (!layers) return tl::unexpected(layers.error());
  SurveyStatistics counted{survey, std::nullopt};
  if (const Layer* layer = named_layer(*layers, request.layer)) {
    auto of_layer = count_layer(services, *model, *layer, request);
    if (!of_layer && gone_meanwhile(of_layer.error())) return std::nullopt;
    if (!of_layer) return tl::unexpected(of_layer.error());
    counted.layer = std::move(*of_layer);
  }
  return counted;
}

// A column of the sheet. `of` returns an empty cell if the layer has no such number.
struct SurveyColumn {
  std::string head;
  std::function<SheetCell(const SurveyLayer&)> of;
};

SheetCell number_cell(const std::optional<double>& number) {
  return number ? SheetCell(*number) : SheetCell();
}

bool has_mean(const SurveyLayer& layer) {
  return !holds_classes(layer.layer) && layer.statistics.texels > 0;
}

void add_value_columns(std::vector<SurveyColumn>& columns, bool with_quantiles) {
  using query::Statistics;
  const auto add = [&](const char* name, double Statistics::*member) {
    columns.push_back({name, [member](const SurveyLayer& layer) {
                         return has_mean(layer) ? SheetCell(layer.statistics.*member) : SheetCell();
                       }});
  };
  add("mean", &Statistics::mean);
  add("min", &Statistics::min);
  add("max", &Statistics::max);
  add("std", &Statistics::std);
  for (std::size_t i = 0; with_quantiles && i < query::kQuantiles.size(); ++i)
    columns.push_back({query::kQuantileNames[i], [i](const SurveyLayer& layer) {
                         const auto& quantiles = layer.statistics.quantiles;
                         return has_mean(layer) && quantiles ? SheetCell((*quantiles)[i])
                                                             : SheetCell();
                       }});
  // Last, because scripts of earlier releases can read the others by their position.
  add("root_mean_square", &Statistics::root_mean_square);
}

// Returns the names of all classes. Classes of different surveys have the same meaning if they have
// the same name.
std::vector<std::string> class_names_of(const std::vector<SurveyStatistics>& surveys) {
  std::vector<std::string> names;
  std::set<std::string> known;
  for (const SurveyStatistics& survey : surveys) {
    if (!survey.layer || !survey.layer->classes) continue;
    for (const SurveyClass& each : *survey.layer->classes)
      if (known.insert(each.name).second) names.push_back(each.name);
  }
  return names;
}

void add_class_areas(std::vector<SheetCell>& row, const std::vector<std::string>& names,
                     const std::optional<SurveyLayer>& layer) {
  std::map<std::string, double> areas_m2;
  const bool has_classes = layer && layer->classes;
  if (has_classes)
    for (const SurveyClass& each : *layer->classes) areas_m2[each.name] += each.area_m2;
  for (const std::string& name : names) {
    SheetCell& cell = row.emplace_back();
    if (has_classes) cell = areas_m2[name];
  }
}

std::vector<SurveyColumn> survey_columns(const std::vector<SurveyStatistics>& surveys) {
  const auto any = [&surveys](const auto& has) {
    return std::ranges::any_of(surveys, [&has](const SurveyStatistics& survey) {
      return survey.layer && has(*survey.layer);
    });
  };
  std::vector<SurveyColumn> columns{
      {"layer", [](const SurveyLayer& of) { return SheetCell(of.layer.slug); }},
      {"unit", [](const SurveyLayer& of) { return SheetCell(of.layer.unit); }},
      {"texels", [](const SurveyLayer& of) { return SheetCell(double(of.statistics.texels)); }},
      {"area_m2", [](const SurveyLayer& of) { return SheetCell(of.statistics.area_m2); }},
      {"percent_of_surface", [](const SurveyLayer& of) { return SheetCell(100 * of.share()); }}};
  if (any([](const SurveyLayer& of) { return of.statistics.pieces.has_value(); }))
    columns.push_back({"pieces", [](const SurveyLayer& of) {
                         const auto& pieces = of.statistics.pieces;
                         return pieces ? SheetCell(double(*pieces)) : SheetCell();
                       }});
  if (any([](const SurveyLayer& of) { return of.statistics.perimeter_m.has_value(); }))
    columns.push_back({"perimeter_m", [](const SurveyLayer& of) {
                         return number_cell(of.statistics.perimeter_m);
                       }});
  if (any([](const SurveyLayer& of) { return !holds_classes(of.layer); }))
    add_value_columns(
        columns, any([](const SurveyLayer& of) { return of.statistics.quantiles.has_value(); }));
  return columns;
}

}  // namespace

double SurveyLayer::share() const {
  return query::share_of_surface(statistics.area_m2, surface_m2);
}

bool holds_classes(const Layer& layer) {
  return layer.kind == LayerKind::database ||
         (layer.palette.mode == PaletteMode::categorical && !is_float(layer.type));
}

const Layer* named_layer(const std::vector<Layer>& layers, const std::string& name) {
  auto found = std::ranges::find(layers, name, &Layer::name);
  if (found == layers.end()) found = std::ranges::find(layers, name, &Layer::slug);
  return found == layers.end() ? nullptr : &*found;
}

Result<std::vector<SurveyStatistics>> survey_statistics(const Services& services,
                                                        const SurveyedObject& object,
                                                        const SurveyStatisticsRequest& request) {
  std::vector<Survey> surveys;
  std::ranges::copy_if(object.surveys, std::back_inserter(surveys), [&](const Survey& survey) {
    return may_be_within(survey.date, request.from, request.to);
  });
  if (surveys.size() > kMaxSurveysAtOnce)
    return fail(ErrorCode::invalid, "Too many surveys",
                "The period contains " + std::to_string(surveys.size()) +
                    " surveys, but one request can compare at most " +
                    std::to_string(kMaxSurveysAtOnce) +
                    ". Choose a shorter period with `from` and `to`.",
                "from");
  std::vector<SurveyStatistics> all;
  ClassCollector classes(services.store, request);
  for (const Survey& survey : surveys) {
    check_question();
    auto counted = STRATA_TRY(count_survey(services, survey, request));
    if (!counted) continue;
    if (counted->layer) STRATA_TRY(classes.collect(*counted->layer));
    all.push_back(std::move(*counted));
  }
  if (!all.empty() && std::ranges::none_of(
                          all, [](const SurveyStatistics& each) { return each.layer.has_value(); }))
    return fail(ErrorCode::invalid, "Layer not found",
                "No survey of " + object.name + " has a layer \"" + request.layer + "\".", "layer");
  if (classes.too_many())
    for (SurveyStatistics& each : all)
      if (each.layer) each.layer->classes.reset();
  return all;
}

Sheet survey_statistics_sheet(const std::vector<SurveyStatistics>& surveys) {
  const auto columns = survey_columns(surveys);
  const auto classes = class_names_of(surveys);
  Sheet sheet{"surveys", {"date", "model"}, {}};
  for (const SurveyColumn& column : columns) sheet.heads.push_back(column.head);
  for (const std::string& name : classes) sheet.heads.push_back(name + " area_m2");
  for (const SurveyStatistics& each : surveys) {
    std::vector<SheetCell> row{each.survey.date, each.survey.slug};
    for (const SurveyColumn& column : columns) {
      SheetCell& cell = row.emplace_back();
      if (each.layer) cell = column.of(*each.layer);
    }
    add_class_areas(row, classes, each.layer);
    sheet.rows.push_back(std::move(row));
    if (each.layer) sheet.name = each.layer->layer.slug + "-surveys";
  }
  sheet.has_totals = false;
  add_readable_areas(sheet);
  return sheet;
}

}  // namespace strata::app
