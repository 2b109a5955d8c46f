#include <map>

#include "app/trash_purger.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/transport/server_options.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<std::string> project_slug(const RouteContext& context, ProjectId project_id) {
  auto project = STRATA_TRY(context.store.projects().find(to_string(project_id)));
  return project.slug;
}

Result<Response> model_answer(const RouteContext& context, const Request& request,
                              const Model& model) {
  auto slug = STRATA_TRY(project_slug(context, model.project_id));
  return with_etag(json_response(to_json(model, slug)), request, model.version);
}

Result<Response> list_models(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto projects = STRATA_TRY(context.store.projects().all());
  std::map<ProjectId, std::string> slugs;
  for (const auto& project : projects) slugs[project.id] = project.slug;
  std::optional<ProjectId> only;
  if (auto parameter = request.query.find("project"); parameter != request.query.end()) {
    STRATA_TRY(check_seen(context, request, parameter->second, "project"));
    auto project = STRATA_TRY(context.store.projects().find(parameter->second));
    only = project.id;
  }
  auto models = STRATA_TRY(context.store.models().all(only));
  std::erase_if(models,
                [&](const Model& model) { return !request.principal->sees(model.project_id); });
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(models.size());
  const auto part =
      slice_by(page, models, [](const Model& model) { return NumberKey{model.id.number()}; });
  if (!part) return tl::unexpected(part.error());
  for (std::size_t i = part->begin; i < part->end; ++i)
    list.push_back(to_json(models[i], slugs[models[i].project_id]));
  Response response = json_response({{"models", list}, {"total", total}});
  add_page_links(response, request, page, part->last);
  return response;
}

Result<void> apply_patch(const protocol::ModelPatch& patch, Model& model) {
  if (patch.name) model.name = *patch.name;
  if (patch.unit) {
    model.unit = *patch.unit;
    model.unit_assumed = false;
  }
  if (patch.scale_verified) model.scale_verified = *patch.scale_verified;
  if (patch.up) model.up = std::string(protocol::name(*patch.up));
  if (patch.north) model.north = *patch.north;
  if (patch.crs) model.crs = *patch.crs;
  if (patch.default_resolution) {
    if (*patch.default_resolution < model.atlas.lowest_resolution)
      return fail(ErrorCode::invalid, "Resolution too low",
                  "Layers of this model must have at least " +
                      std::to_string(model.atlas.lowest_resolution) + " texels on each side.",
                  "default_resolution");
    model.default_resolution = *patch.default_resolution;
  }
  auto set = [](std::string& member, const std::optional<std::string>& value) {
    if (value) member = *value;
  };
  set(model.inventory_number, patch.inventory_number);
  set(model.owner, patch.owner);
  set(model.creator, patch.creator);
  set(model.captured, patch.captured);
  set(model.method, patch.method);
  set(model.accuracy, patch.accuracy);
  set(model.processing, patch.processing);
  set(model.rights_uri, patch.rights_uri);
  set(model.credit, patch.credit);
  if (patch.object) {
    model.object = *patch.object > 0 ? std::optional(ObjectId(*patch.object)) : std::nullopt;
    if (!model.object) model.survey_date.clear();
  }
  set(model.survey_date, patch.survey_date);
  if (patch.source_download)
    model.source_download = *parse_role(protocol::name(*patch.source_download));
  return {};
}

Result<Response> change_model(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::ModelPatch>(request));
  // Changes the model through its room because the room notifies the participants.
  auto room = STRATA_TRY(open_room(context, request));
  Model model = room->model();
  STRATA_TRY(check_if_match(request, model.version));
  STRATA_TRY(apply_patch(body, model));
  auto slug = project_slug(context, model.project_id);
  if (!slug) return tl::unexpected(slug.error());
  const auto answer = [slug = *slug](const Model& now) {
    return json_response(to_json(now, slug)).with("ETag", etag_of(now.version));
  };
  auto changed = room->update_model(std::move(model), idempotent_response<Model>(request, answer));
  if (!changed) return tl::unexpected(changed.error());
  return answer(*changed);
}

Result<Response> source(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(stored_model(context, request));
  STRATA_TRY(check_source_download(request, model));
  const std::string& name = request.param("name");
  for (const auto& file : model.source_files) {
    if (file.name != name) continue;
    const std::string etag = "\"" + file.sha256 + "\"";
    if (names_tag(request.header("if-none-match"), etag))
      return empty_response(304).with("ETag", etag);
    Response response;
    response.with("Content-Type", "application/octet-stream").with("ETag", etag);
    name_download(response, file.name);
    response.stream = Response::Stream{
        file.bytes, [&store = context.store, id = model.id, name](const Response::Sink& sink) {
          return store.models().read_source(id, name, sink).has_value();
        }};
    return response;
  }
  return fail(
      ErrorCode::not_found, "File not found",
      "The server did not import this model from a file with this name. See `source_files`.",
      "name");
}

}  // namespace

void add_model_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models",
              .handler = answering(
                  [&context](const Request& request) { return list_models(context, request); }),
              .role = Role::guest,
              .query = {"project", "limit", "offset", "after"}});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto model = STRATA_TRY(stored_model(context, request));
                return model_answer(context, request, model);
              })});
  router.add({.method = Method::patch,
              .pattern = "/api/v1/models/{model}",
              .handler = answering(
                  [&context](const Request& request) { return change_model(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::remove,
              .pattern = "/api/v1/models/{model}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto model = STRATA_TRY(stored_model(context, request));
                STRATA_TRY(check_if_match(request, model.version));
                STRATA_TRY(context.store.trash().put_model(
                    model.id, idempotent_response<>(request, [] { return empty_response(204); })));
                context.rooms.forget(model.id);
                if (context.options.trash_days == 0) context.trash_purger.check_now();
                return empty_response(204);
              }),
              .role = Role::curator,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/source/{name}",
              .handler = answering(
                  [&context](const Request& request) { return source(context, request); })});
}

}  // namespace strata::net
