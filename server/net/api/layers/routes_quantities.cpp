#include <algorithm>

#include "app/figures/class_names.h"
#include "app/records/feature_measures.h"
#include "app/records/painted_keys.h"
#include "app/records/record_measures.h"
#include "core/compensated_sum.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "domain/tables/term_list.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/sheet_response.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/layers.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

using Features = app::FeatureMeasures;
using Names = app::RecordNames;

nlohmann::json sums_json(const query::Quantity& quantity) {
  return {{"pieces", quantity.pieces}, {"texels", quantity.texels}, {"area_m2", quantity.area_m2}};
}

double share_of(const query::Quantity& quantity, const query::Quantities& all) {
  return query::share_of_surface(quantity.area_m2, all.surface_m2);
}

nlohmann::json quantities_json(const query::Quantities& all, const Layer& layer, const Names& names,
                               const Features& features) {
  nlohmann::json list = nlohmann::json::array();
  const auto add_share = [&](nlohmann::json json, const query::Quantity& quantity) {
    json["share"] = share_of(quantity, all);
    return json;
  };
  for (const query::Quantity& quantity : all.classes) {
    nlohmann::json json = add_share(sums_json(quantity), quantity);
    const std::string label = app::quantity_label(quantity, layer, names);
    json["class"] = app::quantity_text(quantity, label);
    if (quantity.value && layer.kind == LayerKind::database) {
      const auto key = static_cast<std::int64_t>(*quantity.value);
      json["key"] = key;
      json["has_record"] = names.contains(key);
      app::add_measures(json, features.names, features.of(key));
    } else if (quantity.value) {
      json["value"] = *quantity.value;
    }
    if (quantity.from) json["from"] = *quantity.from;
    if (quantity.to) json["to"] = *quantity.to;
    list.push_back(std::move(json));
  }
  const std::size_t count = list.size();
  nlohmann::json sum = add_share(sums_json(all.sum), all.sum);
  app::add_measures(sum, features.names, features.sum());
  return {{"quantities", std::move(list)},
          {"total", count},
          {"sum", std::move(sum)},
          {"surface_m2", all.surface_m2}};
}

app::Sheet to_sheet(const query::Quantities& all, const Layer& layer, const Names& names,
                    const Features& features, const std::string& name) {
  app::Sheet sheet{name, {"class"}, {}};
  const bool has_keys = layer.kind == LayerKind::database,
             has_values = query::classes_of(layer).each;
  if (has_keys)
    sheet.heads.emplace_back("key");
  else if (has_values)
    sheet.heads.emplace_back("value");
  else
    sheet.heads.insert(sheet.heads.end(), {"from", "to"});
  sheet.heads.insert(sheet.heads.end(), {"pieces", "texels", "area_m2"});
  sheet.heads.insert(sheet.heads.end(), features.names.begin(), features.names.end());
  sheet.heads.emplace_back("percent_of_surface");
  const auto number = [](const std::optional<double>& value) {
    return value ? app::SheetCell(*value) : app::SheetCell();
  };
  const auto add = [&](const query::Quantity& quantity, app::SheetCell name_cell,
                       const std::vector<double>& marked) {
    std::vector<app::SheetCell> row{std::move(name_cell)};
    if (has_keys || has_values)
      row.push_back(number(quantity.value));
    else
      row.insert(row.end(), {number(quantity.from), number(quantity.to)});
    row.insert(row.end(), {double(quantity.pieces), double(quantity.texels), quantity.area_m2});
    row.insert(row.end(), marked.begin(), marked.end());
    row.emplace_back(100 * share_of(quantity, all));
    sheet.rows.push_back(std::move(row));
  };
  for (const query::Quantity& quantity : all.classes) {
    const std::string label = app::quantity_label(quantity, layer, names);
    add(quantity,
        label.empty() && quantity.value ? app::SheetCell(*quantity.value)
                                        : app::quantity_text(quantity, label),
        has_keys ? features.of(static_cast<std::int64_t>(*quantity.value)) : std::vector<double>());
  }
  add(all.sum, "total", features.sum());
  return sheet;
}

Result<Response> quantity_sheet(const RouteContext& context, app::Sheet sheet, SheetFormat format,
                                char separator) {
  app::add_readable_areas(sheet);
  return sheet_response(sheet, format, separator, context.options.upload_dir);
}

Result<Response> layer_quantities(const RouteContext& context, const Request& request) {
  const auto format = STRATA_TRY(sheet_format(request));
  const auto separator = STRATA_TRY(csv_separator(request));
  const auto language = STRATA_TRY(requested_language(request));
  const auto target = STRATA_TRY(LayerQuery::from(context, request));
  auto all = target.room->queries().quantities(target.layer.slug, target.at);
  if (!all) return tl::unexpected(all.error());
  Names names;
  Features features;
  if (target.layer.table) {
    std::optional<std::int64_t> records_at;  // sequence of the table at the edit
    if (target.at) {
      auto found = context.store.tables().sequence_when(*target.layer.table, target.layer.model_id,
                                                        *target.at);
      if (!found) return tl::unexpected(found.error());
      records_at = *found;
    }
    const auto table = context.store.tables().find(to_string(*target.layer.table), request.role());
    if (!table) return tl::unexpected(table.error());
    auto marked =
        Features::of_table(context, *table, request.role(), target.room->model(), records_at);
    if (!marked) return tl::unexpected(marked.error());
    features = std::move(*marked);
    app::add_classes(*all, features);
    std::vector<std::int64_t> keys;
    for (const query::Quantity& quantity : all->classes)
      keys.push_back(static_cast<std::int64_t>(*quantity.value));
    auto found = app::record_names(context.store, *target.layer.table, request.role(),
                                   std::move(keys), records_at, language);
    if (!found) return tl::unexpected(found.error());
    names = std::move(*found);
  }
  auto response =
      STRATA_TRY(format == SheetFormat::json
                     ? json_response(quantities_json(*all, target.layer, names, features))
                     : quantity_sheet(context,
                                      to_sheet(*all, target.layer, names, features,
                                               target.layer.slug + "-quantities"),
                                      format, separator));
  add_sequences(response, target.sequence, target.room->edits().durable_sequence());
  response.with("Vary", "Accept");
  return response;
}

// --- quantities of a table, for all models with layers that contain its keys

struct OfLayer {
  Model model;
  Layer layer;
  std::map<std::int64_t, query::Quantity> of_key;
};

Result<std::vector<OfLayer>> of_layers(const RouteContext& context, TableId table_id,
                                       Role seen_by) {
  auto layers = STRATA_TRY(context.store.layers().of_table(table_id, seen_by));
  std::vector<OfLayer> found;
  for (Layer& layer : layers) {
    if (layer.sequence == 0) continue;  // the layer was never painted
    auto room = STRATA_TRY(context.rooms.open(to_string(layer.model_id), seen_by));
    auto all = room->queries().quantities(layer.slug);
    if (!all && all.error().code == ErrorCode::not_found) continue;  // the layer is deleted
    if (!all) return tl::unexpected(all.error());
    if (all->classes.empty()) continue;
    OfLayer of_layer{room->model(), std::move(layer), {}};
    for (const query::Quantity& quantity : all->classes)
      of_layer.of_key[static_cast<std::int64_t>(*quantity.value)] = quantity;
    found.push_back(std::move(of_layer));
  }
  return found;
}

class QuantitySum {
 public:
  void add(const query::Quantity& part) {
    sum_.pieces += part.pieces;
    sum_.texels += part.texels;
    area_m2_ += part.area_m2;
    sum_.area_m2 = area_m2_.value();
  }
  const query::Quantity& sum() const { return sum_; }

 private:
  query::Quantity sum_;
  CompensatedSum area_m2_;
};

Result<Response> table_quantities(const RouteContext& context, const Request& request) {
  const auto format = STRATA_TRY(sheet_format(request));
  const auto separator = STRATA_TRY(csv_separator(request));
  const auto language = STRATA_TRY(requested_language(request));
  const auto table = STRATA_TRY(stored_table(context, request));
  const auto layers = STRATA_TRY(of_layers(context, table.id, request.role()));
  std::map<std::int64_t, QuantitySum> of_key;
  QuantitySum of_all;
  for (const OfLayer& layer : layers)
    for (const auto& [key, quantity] : layer.of_key) {
      of_key[key].add(quantity);
      of_all.add(quantity);
    }
  const query::Quantity& sum = of_all.sum();
  const auto features = STRATA_TRY(Features::of_table(context, table, request.role(), {}, {}));
  for (const auto& [key, values] : features.of_key) of_key.try_emplace(key);
  std::vector<std::int64_t> keys;
  for (const auto& [key, quantity] : of_key) keys.push_back(key);
  const auto names =
      STRATA_TRY(app::record_names(context.store, table.id, request.role(), keys, {}, language));
  const auto text_of = [&](std::int64_t key) {
    const auto name = names.find(key);
    return name == names.end() || name->second.empty() ? std::to_string(key) : name->second;
  };
  if (format == SheetFormat::json) {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& [key, quantity] : of_key) {
      nlohmann::json json = sums_json(quantity.sum()), parts = nlohmann::json::array();
      for (const OfLayer& layer : layers)
        if (const auto part = layer.of_key.find(key); part != layer.of_key.end()) {
          parts.push_back(sums_json(part->second));
          parts.back()["model"] = layer.model.id;
          parts.back()["layer"] = layer.layer.id;
        }
      json["class"] = text_of(key);
      json["key"] = key;
      json["has_record"] = names.contains(key);
      app::add_measures(json, features.names, features.of(key));
      json["layers"] = std::move(parts);
      list.push_back(std::move(json));
    }
    const std::size_t count = list.size();
    nlohmann::json total = sums_json(sum);
    app::add_measures(total, features.names, features.sum());
    return json_response(
               {{"quantities", std::move(list)}, {"total", count}, {"sum", std::move(total)}})
        .with("Vary", "Accept");
  }
  app::Sheet sheet{table.slug + "-quantities", {"class", "key", "pieces", "texels", "area_m2"}, {}};
  sheet.heads.insert(sheet.heads.end(), features.names.begin(), features.names.end());
  for (const OfLayer& layer : layers)
    sheet.heads.push_back(layer.model.slug + "/" + layer.layer.slug + " area_m2");
  for (const auto& [key, of_one] : of_key) {
    const query::Quantity& quantity = of_one.sum();
    std::vector<app::SheetCell> row{text_of(key), double(key), double(quantity.pieces),
                                    double(quantity.texels), quantity.area_m2};
    const auto marked = features.of(key);
    row.insert(row.end(), marked.begin(), marked.end());
    for (const OfLayer& layer : layers) {
      const auto part = layer.of_key.find(key);
      row.push_back(part == layer.of_key.end() ? app::SheetCell()
                                               : app::SheetCell(part->second.area_m2));
    }
    sheet.rows.push_back(std::move(row));
  }
  std::vector<app::SheetCell> last{
      std::string("total"), {}, double(sum.pieces), double(sum.texels), sum.area_m2};
  const auto marked = features.sum();
  last.insert(last.end(), marked.begin(), marked.end());
  for (const OfLayer& layer : layers) {
    QuantitySum of_layer;
    for (const auto& [key, quantity] : layer.of_key) of_layer.add(quantity);
    last.emplace_back(of_layer.sum().area_m2);
  }
  sheet.rows.push_back(std::move(last));
  auto response = quantity_sheet(context, std::move(sheet), format, separator);
  if (response) response->with("Vary", "Accept");
  return response;
}

}  // namespace

void add_quantity_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/layers/{layer}/quantities",
              .handler = answering([&context](const Request& request) {
                return layer_quantities(context, request);
              }),
              .query = {"at", "lang", "f", "separator"},
              .is_question = true,
              .state = state_of_model(context)});
  router.add({.method = Method::get,
              .pattern = "/api/v1/tables/{table}/quantities",
              .handler = answering([&context](const Request& request) {
                return table_quantities(context, request);
              }),
              .query = {"lang", "f", "separator"},
              .is_question = true,
              .state = state_of_painted_table(context)});
}

}  // namespace strata::net
