#include <algorithm>

#include "app/edits.h"
#include "app/layers/new_layers.h"
#include "app/template_registry.h"
#include "core/log.h"
#include "core/text/search_text.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "domain/tables/term_list.h"
#include "net/api/addressed.h"
#include "net/api/layers/layer_jobs.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "net/live/table_events.h"
#include "net/transport/server_options.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/idempotent_response.h"
#include "store/store.h"
#include "store/tables/table_changes.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

Result<Response> list_templates(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  const auto& templates = context.templates.all();
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(templates.size());
  // The list and its order do not change after the start of the server.
  std::int64_t place = 0;
  const auto part = slice_by(page, templates, [&place](const auto&) { return NumberKey{place++}; });
  if (!part) return tl::unexpected(part.error());
  for (std::size_t i = part->begin; i < part->end; ++i) list.push_back(to_json(templates[i]));
  Response response = json_response({{"templates", std::move(list)}, {"total", total}});
  add_page_links(response, request, page, part->last);
  return response;
}

Response answer_with(const std::vector<Table>& tables, const std::vector<Layer>& layers) {
  nlohmann::json made{{"tables", nlohmann::json::array()}, {"layers", nlohmann::json::array()}};
  for (const Table& table : tables) made["tables"].push_back(to_json(table));
  for (const Layer& layer : layers) made["layers"].push_back(to_json(layer));
  return json_response(made, 201);
}

// A layer to create, and the index of its table in the template.
struct RequestedLayer {
  Layer layer;
  std::size_t table = 0;
};
Result<std::vector<RequestedLayer>> requested_layers(const protocol::Template& of,
                                                     const room::Room& room,
                                                     const std::optional<std::string>& language) {
  const Model model = room.model();
  const auto others = room.layers().all();
  int order = app::order_on_top(others);
  std::vector<RequestedLayer> requested;
  for (const protocol::TemplateLayer& template_layer : of.layers) {
    RequestedLayer next;
    next.layer.model_id = model.id;
    next.layer.name = app::name_in(template_layer.name, template_layer.labels, language);
    next.layer.labels = app::labels_with(template_layer.name, template_layer.labels);
    const std::string plain = search_text(next.layer.name);
    for (const Layer& other : others)
      if (search_text(other.name) == plain)
        return fail(
            ErrorCode::conflict, "Name already used",
            "The model has a layer \"" + other.name +
                "\". Rename or delete that layer first, or use the template without a model.",
            "model");
    if (of.group) next.layer.group = app::name_in(of.group->name, of.group->labels, language);
    auto slug = STRATA_TRY(slug_of({}, template_layer.name));
    next.layer.slug = slug;
    next.layer.kind = LayerKind::database;
    next.layer.type = *parse_value_type(protocol::name(template_layer.type));
    next.layer.resolution = std::max(model.default_resolution, model.atlas.lowest_resolution);
    next.layer.order = order++;
    next.table = static_cast<std::size_t>(
        std::find_if(of.tables.begin(), of.tables.end(),
                     [&](const auto& table) { return table.slug == template_layer.table; }) -
        of.tables.begin());
    next.layer.palette =
        of.tables.at(next.table).terms ? terms_palette({}) : default_palette(next.layer.type, true);
    requested.push_back(std::move(next));
  }
  return requested;
}

// Removes the newest table first because columns of later tables refer to earlier tables.
void take_back(const RouteContext& context, const std::vector<Table>& tables) {
  for (auto table = tables.rbegin(); table != tables.rend(); ++table)
    if (auto gone = context.store.tables().remove(table->id);
        !gone && gone.error().code != ErrorCode::not_found)
      log::warning("table " + to_string(table->id) +
                   " of a template that failed could not be removed: " + gone.error().detail);
}

Result<std::vector<Layer>> make_layers(const RouteContext& context, const Request& request,
                                       const std::shared_ptr<room::Room>& room,
                                       std::vector<RequestedLayer> requested,
                                       const std::vector<Table>& tables) {
  app::NewLayers layers(room, context.edits, request.author());
  std::vector<Layer> made;
  const auto refuse = [&](const Error& problem) {
    layers.take_back();
    return tl::unexpected(problem);
  };
  for (RequestedLayer& next : requested) {
    next.layer.table = tables.at(next.table).id;
    auto created = layers.add(std::move(next.layer),
                              [](const Layer& layer) -> Result<Layer> { return layer; });
    if (!created) return refuse(created.error());
    made.push_back(std::move(*created));
  }
  const auto now = [&](const Layer& last) {
    for (Layer& layer : made) {
      if (layer.id == last.id)
        layer = last;
      else if (auto shown = room->layers().find(to_string(layer.id)))
        layer = std::move(*shown);
    }
    return answer_with(tables, made);
  };
  if (auto shown = layers.show(idempotent_response<Layer>(request, now)); !shown)
    return refuse(shown.error());
  for (Layer& layer : made)
    if (auto shown = room->layers().find(to_string(layer.id))) layer = std::move(*shown);
  return made;
}

Result<Response> use_template(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::TemplateUse>(request));
  auto project = STRATA_TRY(stored_project(context, request));
  const protocol::Template* of = context.templates.find(request.param("template"));
  if (!of)
    return fail(ErrorCode::not_found, "Not found",
                "There is no template `" + request.param("template").substr(0, 100) + "`.");
  auto tables = STRATA_TRY(app::new_tables(*of, project.id, body.language));
  std::shared_ptr<room::Room> room;
  std::vector<RequestedLayer> requested;
  if (body.model) {
    auto opened = context.rooms.open(*body.model, request.role());
    if (!opened && opened.error().code != ErrorCode::not_found)
      return tl::unexpected(opened.error());
    if (!opened || (*opened)->model().project_id != project.id)
      return fail(ErrorCode::invalid, "Model not found",
                  "The project has no model `" + *body.model + "`.", "model");
    room = std::move(*opened);
    auto layers = STRATA_TRY(requested_layers(*of, *room, body.language));
    requested = std::move(layers);
  }
  // The last operation stores the response for repeated calls. If there are no layers, the last
  // operation creates the tables.
  const auto tables_alone = [](const std::vector<store::TableChange>& changes) {
    std::vector<Table> all;
    for (const auto& change : changes) all.push_back(change.table);
    return answer_with(all, {});
  };
  auto changes = STRATA_TRY(context.store.tables().create_several(
      tables, false, request.user(), "template",
      requested.empty()
          ? idempotent_response<std::vector<store::TableChange>>(request, tables_alone)
          : store::IdempotentResponse<std::vector<store::TableChange>>{
                .key = {}, .make = {}, .user = request.user()}));
  std::vector<Table> made;
  for (const auto& change : changes) {
    if (!change.problems.empty()) return tl::unexpected(change.problems.front().problem);
    made.push_back(change.table);
  }
  std::vector<Layer> layers;
  if (!requested.empty()) {
    auto added = make_layers(context, request, room, std::move(requested), made);
    if (!added) {
      take_back(context, made);
      return tl::unexpected(added.error());
    }
    layers = std::move(*added);
  }
  for (const Table& table : made)
    tell_table(context.live_sockets, protocol::TableEventEvent::created, table, request.user());
  return answer_with(made, layers);
}

}  // namespace

void add_template_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/templates",
              .handler = answering(
                  [&context](const Request& request) { return list_templates(context, request); }),
              .role = Role::guest,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = "/api/v1/projects/{project}/templates/{template}",
              .handler = answering(
                  [&context](const Request& request) { return use_template(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true});
}

}  // namespace strata::net
