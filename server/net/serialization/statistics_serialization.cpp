#include "net/serialization/statistics_serialization.h"

#include <array>

#include "core/text/csv.h"
#include "query/statistics/cross_table.h"
#include "query/statistics/statistics.h"
#include "room/queries.h"

namespace strata::net {
namespace {

nlohmann::json vec3(const glm::dvec3& v) { return nlohmann::json::array({v.x, v.y, v.z}); }

}  // namespace

nlohmann::json bounds_json(const glm::dvec3& low, const glm::dvec3& high) {
  return {{"min", vec3(low)}, {"max", vec3(high)}};
}

nlohmann::json to_json(const query::Statistics& statistics) {
  nlohmann::json json{{"texels", statistics.texels}, {"area_m2", statistics.area_m2}};
  if (statistics.texels > 0) {
    json["min"] = statistics.min;
    json["max"] = statistics.max;
    json["mean"] = statistics.mean;
    json["std"] = statistics.std;
  }
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
    if (entry.pieces) of_key["pieces"] = *entry.pieces;
    if (entry.perimeter_m) of_key["perimeter_m"] = *entry.perimeter_m;
    keys.push_back(std::move(of_key));
  }
  json["keys"] = std::move(keys);
  if (statistics.pieces) json["pieces"] = *statistics.pieces;
  if (statistics.perimeter_m) json["perimeter_m"] = *statistics.perimeter_m;
  if (statistics.quantiles) {
    static constexpr std::array kNames = {"p5", "p25", "p50", "p75", "p95"};
    static_assert(kNames.size() == query::kQuantiles.size());
    for (std::size_t i = 0; i < kNames.size(); ++i)
      json["quantiles"][kNames[i]] = (*statistics.quantiles)[i];
  }
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

nlohmann::json to_json(const query::CrossTable& table) {
  const auto keys = [](const std::vector<query::CrossTable::Key>& side) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& key : side)
      list.push_back(key ? nlohmann::json(static_cast<std::int64_t>(*key)) : nlohmann::json());
    return list;
  };
  return {{"rows", keys(table.rows)},
          {"columns", keys(table.columns)},
          {"area_m2", table.area_m2},
          {"texels", table.texels}};
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
