#include "net/serialization/statistics_serialization.h"

#include "app/layers/survey_statistics.h"
#include "core/text/csv.h"
#include "net/api/route_help.h"
#include "query/statistics/agreement.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"

namespace strata::net {
namespace {

nlohmann::json vec3(const glm::dvec3& v) { return nlohmann::json::array({v.x, v.y, v.z}); }

void add_values(nlohmann::json& json, const query::Statistics& statistics) {
  if (statistics.texels > 0) {
    json["min"] = statistics.min;
    json["max"] = statistics.max;
    json["mean"] = statistics.mean;
    json["std"] = statistics.std;
    json["root_mean_square"] = statistics.root_mean_square;
  }
  if (statistics.quantiles)
    for (std::size_t i = 0; i < query::kQuantileNames.size(); ++i)
      json["quantiles"][query::kQuantileNames[i]] = (*statistics.quantiles)[i];
}

template <class Measured>
void add_pieces(nlohmann::json& json, const Measured& measured) {
  if (measured.pieces) json["pieces"] = *measured.pieces;
  if (measured.perimeter_m) json["perimeter_m"] = *measured.perimeter_m;
}

nlohmann::json class_json(const app::SurveyClass& each) {
  nlohmann::json json{
      {"key", each.key}, {"class", each.name}, {"texels", each.texels}, {"area_m2", each.area_m2}};
  add_pieces(json, each);
  return json;
}

nlohmann::json layer_json(const app::SurveyLayer& of) {
  nlohmann::json json{{"layer", of.layer.id},
                      {"slug", of.layer.slug},
                      {"unit", of.layer.unit},
                      {"sequence", of.sequence},
                      {"texels", of.statistics.texels},
                      {"area_m2", of.statistics.area_m2},
                      {"share", of.share()}};
  add_pieces(json, of.statistics);
  if (!app::holds_classes(of.layer)) add_values(json, of.statistics);
  if (of.classes) {
    json["classes"] = nlohmann::json::array();
    for (const app::SurveyClass& each : *of.classes) json["classes"].push_back(class_json(each));
  }
  return json;
}

nlohmann::json key_json(const query::CrossTable::Key& key) {
  return key ? nlohmann::json(static_cast<std::int64_t>(*key)) : nlohmann::json();
}

nlohmann::json or_null(const std::optional<double>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

}  // namespace

Result<room::StatisticsOptions> statistics_options(const Request& request) {
  room::StatisticsOptions options;
  for (const auto& part : split_list(request.query_or("include", {}))) {
    if (part == "pieces")
      options.pieces = true;
    else if (part == "perimeter")
      options.perimeter = true;
    else if (part == "quantiles")
      options.quantiles = true;
    else
      return fail(ErrorCode::invalid, "Unknown part",
                  "`include` accepts pieces, perimeter and quantiles, separated by commas.",
                  "include");
  }
  return options;
}

room::StatisticsOptions statistics_options(
    const std::optional<std::vector<protocol::StatisticsPart>>& include) {
  room::StatisticsOptions options;
  for (const auto part : include.value_or(std::vector<protocol::StatisticsPart>{})) switch (part) {
      case protocol::StatisticsPart::pieces: options.pieces = true; break;
      case protocol::StatisticsPart::perimeter: options.perimeter = true; break;
      case protocol::StatisticsPart::quantiles: options.quantiles = true; break;
    }
  return options;
}

nlohmann::json bounds_json(const glm::dvec3& low, const glm::dvec3& high) {
  return {{"min", vec3(low)}, {"max", vec3(high)}};
}

nlohmann::json to_json(const query::Statistics& statistics) {
  nlohmann::json json{{"texels", statistics.texels}, {"area_m2", statistics.area_m2}};
  add_values(json, statistics);
  nlohmann::json bins = nlohmann::json::array();
  for (const auto& bin : statistics.histogram)
    bins.push_back(
        {{"from", bin.from}, {"to", bin.to}, {"texels", bin.texels}, {"area_m2", bin.area_m2}});
  json["histogram"] = std::move(bins);
  nlohmann::json keys = nlohmann::json::array();
  for (const auto& [key, entry] : statistics.keys) {
    nlohmann::json of_key{{"key", static_cast<std::int64_t>(key)},  // only for integer layers
                          {"texels", entry.texels},
                          {"area_m2", entry.area_m2},
                          {"centroid", vec3(entry.centroid)},
                          {"bounds", bounds_json(entry.bounds_min, entry.bounds_max)}};
    add_pieces(of_key, entry);
    keys.push_back(std::move(of_key));
  }
  json["keys"] = std::move(keys);
  add_pieces(json, statistics);
  return json;
}

nlohmann::json to_json(const room::SelectedArea& area) {
  nlohmann::json json{{"resolution", area.resolution},
                      {"texels", area.texels},
                      {"area_m2", area.area_m2},
                      {"share", area.share},
                      {"layers", nlohmann::json::object()}};
  if (area.texels > 0) json["bounds"] = bounds_json(area.bounds_min, area.bounds_max);
  for (const auto& [slug, statistics] : area.layers) json["layers"][slug] = to_json(statistics);
  return json;
}

nlohmann::json to_json(const app::SurveyStatistics& statistics) {
  const auto& [survey, layer] = statistics;
  return {{"model", survey.model},
          {"slug", survey.slug},
          {"name", survey.name},
          {"date", survey.date},
          {"statistics", layer ? layer_json(*layer) : nlohmann::json()}};
}

nlohmann::json to_json(const query::CrossTable& table) {
  const auto keys = [](const std::vector<query::CrossTable::Key>& side) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& key : side) list.push_back(key_json(key));
    return list;
  };
  return {{"rows", keys(table.rows)},
          {"columns", keys(table.columns)},
          {"area_m2", table.area_m2},
          {"texels", table.texels}};
}

nlohmann::json to_json(const query::Agreement& agreement) {
  nlohmann::json classes = nlohmann::json::array();
  for (const query::ClassAgreement& each : agreement.classes)
    classes.push_back({{"key", key_json(each.key)},
                       {"area_both_m2", each.both_m2},
                       {"area_first_m2", each.first_m2},
                       {"area_second_m2", each.second_m2},
                       {"iou", each.iou()},
                       {"f1", each.f1()}});
  return {{"area_m2", agreement.area_m2},
          {"observed", agreement.observed},
          {"expected", agreement.expected},
          {"kappa", or_null(agreement.kappa)},
          {"observed_painted", or_null(agreement.observed_painted)},
          {"classes", std::move(classes)}};
}

std::string cross_table_csv(const query::CrossTable& table, const std::string& rows,
                            const std::string& columns) {
  const auto key_text = [](const query::CrossTable::Key& key) {
    return key ? csv_number(*key, ',') : std::string("-");
  };
  std::vector<std::string> cells{rows + " / " + columns};
  for (const auto& column : table.columns) cells.push_back(key_text(column));
  std::string text = csv_line(cells, ',');
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    cells.assign(1, key_text(table.rows[row]));
    for (const double area : table.area_m2[row]) cells.push_back(csv_number(area, ','));
    text += csv_line(cells, ',');
  }
  return text;
}

}  // namespace strata::net
