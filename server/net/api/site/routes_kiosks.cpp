// Links for kiosks: requests from curators, and requests from kiosks.
#include <memory>

#include "core/no_such.h"
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/auth.h"
#include "net/auth/login_throttle.h"
#include "net/auth/project_authorization.h"
#include "net/http/origin.h"
#include "net/http/page.h"
#include "net/live/close_codes.h"
#include "net/live/live_sockets.h"
#include "net/serialization/tour_serialization.h"
#include "net/transport/server_options.h"
#include "store/people/kiosks.h"
#include "store/store.h"

namespace strata::net {

void end_kiosks(const RouteContext& context, const std::vector<KioskId>& kiosks,
                const std::string& reason) {
  context.auth.forget();
  for (const KioskId id : kiosks)
    context.live_sockets.close_user(kiosk_name(id), kClosePolicy, reason);
}

namespace {

using store::Kiosk;

nlohmann::json to_json(const Kiosk& kiosk) {
  nlohmann::json json{{"id", kiosk.id},
                      {"name", kiosk.name},
                      {"project", kiosk.project},
                      {"model", kiosk.model},
                      {"model_name", kiosk.model_name},
                      {"tour", kiosk.tour},
                      {"tour_name", kiosk.tour_name},
                      {"user", kiosk.user},
                      {"created", utc_text(kiosk.created)},
                      {"wants_reload", kiosk.wants_reload},
                      {"phones", !kiosk.phone.empty()}};
  if (kiosk.expires) json["expires"] = utc_text(*kiosk.expires);
  if (kiosk.last_seen) json["last_seen"] = utc_text(*kiosk.last_seen);
  if (kiosk.revoked) json["revoked"] = utc_text(*kiosk.revoked);
  return json;
}

Result<Response> list_kiosks(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const Roles& roles = request.principal->roles;
  std::optional<std::vector<ProjectId>> projects;
  if (roles.everywhere < Role::curator) {
    projects.emplace();
    for (const auto& [project, role] : roles.in_projects)
      if (role >= Role::curator) projects->push_back(project);
  }
  const auto after = STRATA_TRY(number_after(page));
  auto found = STRATA_TRY(context.store.kiosks().all(projects, page.limit + 1, page.offset, after));
  const auto last =
      end_page(found.kiosks, page, [](const Kiosk& kiosk) { return ListPlace::array({kiosk.id}); });
  nlohmann::json kiosks = nlohmann::json::array();
  for (const Kiosk& kiosk : found.kiosks) kiosks.push_back(to_json(kiosk));
  Response response = json_response({{"kiosks", std::move(kiosks)}, {"total", found.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> create_kiosk(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::KioskCreate>(request));
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto tour = STRATA_TRY(context.store.tours().find(model.id, request.param("tour")));
  std::optional<std::chrono::seconds> lifetime;
  if (body.days) lifetime = std::chrono::hours(24 * *body.days);
  const auto made = STRATA_TRY(
      context.store.kiosks().create(tour.id, body.name, request.user(), lifetime, body.phones));
  return json_response({{"path", "/kiosk/" + made.secret}, {"kiosk", to_json(made.kiosk)}}, 201)
      .with("Location", "/api/v1/kiosks/" + to_string(made.kiosk.id))
      .with("Cache-Control", "no-store");
}

Result<Response> revoke_kiosk(const RouteContext& context, const Request& request) {
  const auto id = STRATA_TRY(id_of<KioskId>(request, "kiosk"));
  STRATA_TRY(context.store.kiosks().revoke(id));
  end_kiosks(context, {id}, "the link was revoked");
  return empty_response(204);
}

Result<Response> reload_kiosk(const RouteContext& context, const Request& request) {
  const auto id = STRATA_TRY(id_of<KioskId>(request, "kiosk"));
  const auto kiosk = STRATA_TRY(context.store.kiosks().ask_reload(id));
  return json_response(to_json(kiosk));
}

Result<Response> change_kiosk(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::KioskPatch>(request));
  const auto id = STRATA_TRY(id_of<KioskId>(request, "kiosk"));
  const auto kiosk = STRATA_TRY(context.store.kiosks().allow_phones(id, body.phones));
  // Closes the connections of the phones and of the screen, which have the same name. The screen
  // then reconnects.
  if (!body.phones) end_kiosks(context, {id}, "the link for phones is switched off");
  return json_response(to_json(kiosk));
}

// --- requests from kiosks

Result<Response> self(const RouteContext& context, const Kiosk& kiosk, bool is_phone,
                      bool wants_reload) {
  const auto tour =
      STRATA_TRY(context.store.tours().find(kiosk.model_id, to_string(kiosk.tour_id)));
  auto tour_json = STRATA_TRY(to_json(context, tour, Role::viewer, {}));
  nlohmann::json json{
      {"id", kiosk.id},       {"name", kiosk.name},           {"project", kiosk.project},
      {"model", kiosk.model}, {"tour", std::move(tour_json)}, {"wants_reload", wants_reload}};
  if (kiosk.expires) json["expires"] = utc_text(*kiosk.expires);
  if (is_phone) json["is_phone"] = true;
  if (!is_phone && !kiosk.phone.empty()) json["phone_path"] = "/kiosk/" + kiosk.phone;
  return json_response(json).with("Cache-Control", "no-store");
}

Result<Response> sign_in(const RouteContext& context, LoginThrottle& gate, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::KioskLogin>(request));
  const std::string address = address_of(request);
  STRATA_TRY(gate.pass(address, {}));
  const auto kiosk = STRATA_TRY(context.store.kiosks().find(body.link));
  if (!kiosk)
    return fail(ErrorCode::unauthenticated, "Link is not valid",
                "This link does not exist, has expired or was revoked. Ask a curator for a new "
                "link.",
                "link");
  gate.was_right(address, {});
  if (!kiosk->is_phone) STRATA_TRY(context.store.kiosks().seen(kiosk->id, true));
  auto response = self(context, *kiosk, kiosk->is_phone, false);
  if (response)
    response->with("Set-Cookie",
                   Authenticator::set_kiosk_cookie(body.link, needs_secure_cookie(request)));
  return response;
}

Result<Response> kiosk_self(const RouteContext& context, const Request& request) {
  if (!request.principal->kiosk)
    return fail(ErrorCode::forbidden, "Not a kiosk",
                "Only kiosks can read this. Send the cookie of a kiosk with `as=kiosk`, or its "
                "bearer token.");
  // Finds the kiosk by its secret. The secret shows whether the client is the screen or a phone.
  const auto found = STRATA_TRY(context.store.kiosks().find(Authenticator::secret_of(request)));
  if (!found) return no_such("kiosk", to_string(request.principal->kiosk->id));
  // Ignores errors because this call only records the visit. The kiosk gets its response even if
  // the database refuses writes.
  if (!found->is_phone) (void)context.store.kiosks().seen(found->id, false);
  return self(context, *found, found->is_phone, !found->is_phone && found->wants_reload);
}

}  // namespace

void add_kiosk_routes(Router& router, const RouteContext& context) {
  using Answer = Result<Response> (*)(const RouteContext&, const Request&);
  const auto answer_by = [&context](Answer answer) {
    return answering(
        [&context, answer](const Request& request) { return answer(context, request); });
  };
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/tours/{tour}/kiosks",
              .handler = answer_by(create_kiosk),
              .role = Role::curator,
              .check = check_no_script,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  router.add({.method = Method::get,
              .pattern = "/api/v1/kiosks",
              .handler = answer_by(list_kiosks),
              .role = Role::guest,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::remove,
              .pattern = "/api/v1/kiosks/{kiosk}",
              .handler = answer_by(revoke_kiosk),
              .role = Role::curator});
  router.add({.method = Method::patch,
              .pattern = "/api/v1/kiosks/{kiosk}",
              .handler = answer_by(change_kiosk),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  router.add({.method = Method::post,
              .pattern = "/api/v1/kiosks/{kiosk}/reload",
              .handler = answer_by(reload_kiosk),
              .role = Role::curator});
  auto gate = std::make_shared<LoginThrottle>();
  router.add({.method = Method::post,
              .pattern = "/api/v1/auth/kiosk",
              .handler = answering([&context, gate](const Request& request) {
                return sign_in(context, *gate, request);
              }),
              .role = std::nullopt,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  router.add({.method = Method::get,
              .pattern = "/api/v1/kiosk",
              .handler = answer_by(kiosk_self),
              .role = Role::guest});
}

}  // namespace strata::net
