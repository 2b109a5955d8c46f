// Tours of a model. Viewers can read them, and curators can create and change them.
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/serialization/tour_serialization.h"
#include "net/serialization/tour_theme.h"
#include "store/content/named_parts.h"
#include "store/people/kiosks.h"
#include "store/store.h"
#include "store/tables/attachments.h"

namespace strata::net {
namespace {

using store::NamedPart;

struct Found {
  Model model;
  NamedPart tour;
};
Result<Found> find_tour(const RouteContext& context, const Request& request) {
  auto model = STRATA_TRY(stored_model(context, request));
  auto tour = STRATA_TRY(context.store.tours().find(model.id, request.param("tour")));
  return Found{std::move(model), std::move(tour)};
}
Result<Found> find_to_change(const RouteContext& context, const Request& request) {
  auto found = STRATA_TRY(find_tour(context, request));
  STRATA_TRY(check_if_match(request, found.tour.version));
  return found;
}

constexpr std::chrono::hours kUnusedFor{24};  // an open editor may still use newer files

Result<TourFilesById> files_of(const RouteContext& context, NamedPartId tour_id) {
  TourFilesById files;
  const auto all = STRATA_TRY(context.store.tour_files().of_tour(tour_id));
  for (const store::TourFile& file : all) files[file.id] = file;
  return files;
}

// Copies the optional members of a request: media, theme and names of classes. An empty theme or
// list removes the stored one.
template <class Body>
Result<void> take_design(const RouteContext& context, const Request& request, const Model& model,
                         const Body& body, const TourFilesById& files, nlohmann::json& content) {
  const auto put = [&](const char* member, nlohmann::json value) {
    if (value.empty())
      content.erase(member);
    else
      content[member] = std::move(value);
  };
  if (body.theme) {
    STRATA_TRY(check_theme_colors(*body.theme));
    STRATA_TRY(check_logo(*body.theme, files));
    put("theme", protocol::to_json(*body.theme));
  }
  if (body.classes) {
    auto classes = STRATA_TRY(stored_classes(context, model, request.role(), *body.classes));
    put("classes", std::move(classes));
  }
  return {};
}

// The transaction that stores the tour calls this function. `tour_json` contains the names and is
// read before the transaction.
Response answer_of(nlohmann::json tour_json, const NamedPart& now, int status) {
  tour_json.update(
      {{"id", now.id}, {"slug", now.slug}, {"time", utc_text(now.time)}, {"version", now.version}});
  return json_response(tour_json, status).with("ETag", etag_of(now.version));
}

Result<Response> list_tours(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto after = STRATA_TRY(number_after(page));
  auto found =
      STRATA_TRY(context.store.tours().of_model(model.id, page.limit + 1, page.offset, after));
  const auto last = end_page(found.parts, page,
                             [](const NamedPart& tour) { return ListPlace::array({tour.id}); });
  nlohmann::json tours = nlohmann::json::array();
  for (const NamedPart& tour : found.parts) tours.push_back(tour_entry(tour, tour.user));
  Response response = json_response({{"tours", std::move(tours)}, {"total", found.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> get_tour(const RouteContext& context, const Request& request) {
  const auto found = STRATA_TRY(find_tour(context, request));
  const auto tour_json =
      to_json(context, found.tour, request.role(), visible_name(request, found.tour.user));
  if (!tour_json) return tl::unexpected(tour_json.error());
  return with_etag(json_response(*tour_json), request, found.tour.version);
}

Result<Response> create_tour(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::TourCreate>(request));
  const auto model = STRATA_TRY(stored_model(context, request));
  auto stops = STRATA_TRY(stored_stops(context, model, request.role(), body.stops, {}));
  NamedPart tour;
  tour.model_id = model.id;
  tour.name = body.name;
  tour.text = body.text.value_or("");
  tour.content = {
      {"languages", body.languages}, {"idle_s", body.idle_s}, {"stops", std::move(stops)}};
  tour.user = request.user();
  STRATA_TRY(take_design(context, request, model, body, {}, tour.content));
  STRATA_TRY(check_languages(tour.content, true));
  const auto tour_json = STRATA_TRY(to_json(context, tour, request.role(), tour.user));
  const auto answer = [&](const NamedPart& made) {
    return answer_of(tour_json, made, 201)
        .with("Location", "/api/v1/models/" + model.slug + "/tours/" + made.slug);
  };
  const auto made = STRATA_TRY(
      context.store.tours().create(tour, idempotent_response<NamedPart>(request, answer)));
  return answer(made);
}

Result<Response> change_tour(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::TourPatch>(request));
  auto found = STRATA_TRY(find_to_change(context, request));
  NamedPart& tour = found.tour;
  if (body.name) tour.name = *body.name;
  if (body.text) tour.text = *body.text;
  if (body.languages) tour.content["languages"] = *body.languages;
  if (body.idle_s) tour.content["idle_s"] = *body.idle_s;
  const auto files = STRATA_TRY(files_of(context, tour.id));
  STRATA_TRY(take_design(context, request, found.model, body, files, tour.content));
  if (body.stops) {
    auto stops = STRATA_TRY(stored_stops(context, found.model, request.role(), *body.stops, files));
    tour.content["stops"] = std::move(stops);
  }
  STRATA_TRY(check_languages(tour.content, body.stops.has_value()));
  const auto tour_json = STRATA_TRY(to_json(context, tour, request.role(), tour.user));
  const auto answer = [&](const NamedPart& now) { return answer_of(tour_json, now, 200); };
  const auto changed = STRATA_TRY(
      context.store.tours().update(tour, idempotent_response<NamedPart>(request, answer)));
  // Ignores errors, because the next change to the tour deletes these files.
  (void)context.store.tour_files().drop_unused(tour.id, files_in(changed.content), kUnusedFor);
  return answer(changed);
}

Result<Response> delete_tour(const RouteContext& context, const Request& request) {
  const auto found = STRATA_TRY(find_to_change(context, request));
  const auto kiosks = STRATA_TRY(context.store.kiosks().of_tour(found.tour.id));
  const auto answer = [] { return empty_response(204); };
  const auto files = STRATA_TRY(files_of(context, found.tour.id));
  STRATA_TRY(context.store.tours().remove(found.tour, idempotent_response<>(request, answer)));
  // Ignores errors because the next start also deletes these files.
  if (!files.empty()) (void)context.store.attachments().drop_orphans();
  end_kiosks(context, kiosks, "the tour was deleted");
  return answer();
}

}  // namespace

void add_tour_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context, Role::curator);
  const std::string tours = "/api/v1/models/{model}/tours", tour = tours + "/{tour}";
  routes.read(tours, list_tours, {"limit", "offset", "after"});
  routes.change(Method::post, tours, create_tour);
  routes.read(tour, get_tour);
  routes.change(Method::patch, tour, change_tour);
  routes.change(Method::remove, tour, delete_tour);
}

}  // namespace strata::net
