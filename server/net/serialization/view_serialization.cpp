#include "net/serialization/view_serialization.h"

#include <algorithm>

#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "expression/expression_parser.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/surface_images.h"
#include "room/view_settings.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

// Removes settings with columns that are deleted or invisible to the role.
void leave_out_columns(store::Store& store, Role role, TableId table_id, nlohmann::json& shown) {
  if (const auto palette = shown.find("palette");
      palette != shown.end() && palette->contains("column")) {
    const auto table = store.tables().find(to_string(table_id), role);
    if (!table || !find_column(table->columns, palette->at("column").get<std::string>()))
      shown.erase(palette);
  }
  if (const auto highlight = shown.find("highlight");
      highlight != shown.end() && highlight->contains("filter")) {
    store::RecordQuery record_query;
    record_query.limit = 1;
    auto filter = query::parse_condition(highlight->at("filter").get<std::string>(), "filter",
                                         query::Names::columns);
    if (filter) record_query.filter = std::move(*filter);
    if (!filter || !store.records().page(table_id, role, record_query)) shown.erase(highlight);
  }
}

// Removes the elements whose `member` refers to an entity that is not in `there`.
template <class There>
void leave_out(nlohmann::json& list, const char* member, const There& there) {
  list.erase(std::remove_if(list.begin(), list.end(),
                            [&](const nlohmann::json& entry) {
                              return std::ranges::none_of(there, [&](const auto& each) {
                                return each.id ==
                                       entry.at(member).template get<decltype(each.id)>();
                              });
                            }),
             list.end());
}

}  // namespace

void leave_out_unseen(store::Store& store, Role role, const room::Room& room,
                      nlohmann::json& shown_layers) {
  const auto layers = room.layers().all();
  leave_out(shown_layers, "layer", layers);
  for (nlohmann::json& shown : shown_layers)
    for (const Layer& layer : layers)
      if (layer.table && layer.id == shown.at("layer").get<LayerId>())
        leave_out_columns(store, role, *layer.table, shown);
}

nlohmann::json stored_layers(const std::vector<protocol::LayerOverride>& overrides,
                             const room::ViewSettings& settings) {
  nlohmann::json layers = nlohmann::json::array();
  for (std::size_t i = 0; i < overrides.size(); ++i) {
    nlohmann::json stored = protocol::to_json(overrides[i]);
    stored["layer"] = settings.layers[i].layer_id;
    layers.push_back(std::move(stored));
  }
  return layers;
}

nlohmann::json to_json(const RouteContext& context, const Request& request,
                       const store::NamedPart& view, const room::Room& room) {
  nlohmann::json json = view.content;
  leave_out_unseen(context.store, request.role(), room, json["layers"]);
  if (json.contains("looks")) leave_out(json["looks"], "look", room.surface_images().all());
  json.update({{"id", view.id},
               {"slug", view.slug},
               {"name", view.name},
               {"text", view.text},
               {"user", visible_name(request, view.user)},
               {"time", utc_text(view.time)},
               {"version", view.version}});
  return json;
}

Result<protocol::ViewCreate> as_view_create(const RouteContext& context, const Request& request,
                                            const store::NamedPart& view, const room::Room& room) {
  const nlohmann::json seen = to_json(context, request, view, room);
  nlohmann::json body{{"name", view.name},
                      {"camera", seen.at("camera")},
                      {"layers", seen.at("layers")},
                      {"light", seen.at("light")}};
  if (seen.contains("looks")) body["looks"] = seen.at("looks");
  return protocol::from_json<protocol::ViewCreate>(body);
}

}  // namespace strata::net
