// Objects of a project, whose models are surveys of them. Viewers can read them, and curators can
// change them. A change to a model puts it into an object (routes_models.cpp).
#include <utility>

#include "app/layers/survey_statistics.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/serialization/sheet_response.h"
#include "net/serialization/statistics_serialization.h"
#include "store/content/objects.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<SurveyedObject> stored_object(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto id = STRATA_TRY(id_of<ObjectId>(request, "object"));
  return context.store.objects().find(project.id, id);
}

Result<Response> list_objects(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto after = STRATA_TRY(number_after(page));
  auto found = STRATA_TRY(
      context.store.objects().of_project(project.id, page.limit + 1, page.offset, after));
  const auto last = end_page(found.objects, page, [](const SurveyedObject& object) {
    return ListPlace::array({object.id});
  });
  nlohmann::json objects = nlohmann::json::array();
  for (const SurveyedObject& object : found.objects) objects.push_back(to_json(object));
  Response response = json_response({{"objects", std::move(objects)}, {"total", found.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> get_object(const RouteContext& context, const Request& request) {
  const auto object = STRATA_TRY(stored_object(context, request));
  return with_etag(json_response(to_json(object)), request, object.version);
}

Result<Response> create_object(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ObjectCreate>(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto answer = [&](const SurveyedObject& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/projects/" + project.slug + "/objects/" + to_string(made.id))
        .with("ETag", etag_of(made.version));
  };
  const auto made = STRATA_TRY(context.store.objects().create(
      project.id, body.name, idempotent_response<SurveyedObject>(request, answer)));
  return answer(made);
}

Result<Response> change_object(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ObjectPatch>(request));
  auto object = STRATA_TRY(stored_object(context, request));
  STRATA_TRY(check_if_match(request, object.version));
  object.name = body.name;
  const auto answer = [](const SurveyedObject& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  const auto changed = STRATA_TRY(
      context.store.objects().rename(object, idempotent_response<SurveyedObject>(request, answer)));
  return answer(changed);
}

Result<Response> delete_object(const RouteContext& context, const Request& request) {
  const auto object = STRATA_TRY(stored_object(context, request));
  STRATA_TRY(check_if_match(request, object.version));
  const auto answer = [] { return empty_response(204); };
  STRATA_TRY(context.store.objects().remove(object, idempotent_response<>(request, answer)));
  return answer();
}

Result<app::SurveyStatisticsRequest> statistics_request(const Request& request) {
  app::SurveyStatisticsRequest wanted;
  wanted.layer = request.query_or("layer", {});
  if (wanted.layer.empty())
    return fail(ErrorCode::invalid, "Layer missing",
                "Send the name or the slug of a layer in `layer`.", "layer");
  wanted.options = STRATA_TRY(statistics_options(request));
  for (auto [name, limit] : {std::pair("from", &wanted.from), std::pair("to", &wanted.to)}) {
    *limit = request.query_or(name, {});
    if (!limit->empty()) STRATA_TRY(check_survey_date(*limit, name));
  }
  wanted.language = STRATA_TRY(requested_language(request));
  wanted.seen_by = request.role();
  return wanted;
}

Result<Response> statistics_of_surveys(const RouteContext& context, const Request& request) {
  const auto format = STRATA_TRY(sheet_format(request));
  const auto separator = STRATA_TRY(csv_separator(request));
  const auto wanted = STRATA_TRY(statistics_request(request));
  const auto object = STRATA_TRY(stored_object(context, request));
  const auto surveys = STRATA_TRY(app::survey_statistics(context, object, wanted));
  if (format != SheetFormat::json) {
    auto sheet = STRATA_TRY(sheet_response(app::survey_statistics_sheet(surveys), format, separator,
                                           context.options.upload_dir));
    return std::move(sheet.with("Vary", "Accept"));
  }
  nlohmann::json list = nlohmann::json::array();
  for (const auto& survey : surveys) list.push_back(to_json(survey));
  return json_response({{"object", object.id}, {"surveys", std::move(list)}})
      .with("Vary", "Accept");
}

}  // namespace

void add_object_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context, Role::curator);
  const std::string objects = "/api/v1/projects/{project}/objects", object = objects + "/{object}";
  routes.read(objects, list_objects, {"limit", "offset", "after"});
  routes.change(Method::post, objects, create_object);
  routes.read(object, get_object);
  routes.change(Method::patch, object, change_object);
  routes.change(Method::remove, object, delete_object);
  router.add({.method = Method::get,
              .pattern = object + "/statistics",
              .handler = answering([&context](const Request& request) {
                return statistics_of_surveys(context, request);
              }),
              .query = {"layer", "include", "from", "to", "lang", "f", "separator"},
              .is_question = true,
              .state = state_of_surveys(context)});
}

}  // namespace strata::net
