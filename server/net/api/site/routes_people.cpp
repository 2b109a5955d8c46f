// Accounts, their roles and invitations.
#include "core/text/percent.h"
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/audit_trail.h"
#include "net/auth/auth.h"
#include "net/http/origin.h"
#include "net/http/page.h"
#include "net/live/close_codes.h"
#include "net/live/live_sockets.h"
#include "net/serialization/people_serialization.h"
#include "net/transport/server_options.h"
#include "room/rooms.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/audit.h"
#include "store/people/password.h"
#include "store/people/people.h"
#include "store/people/tokens.h"
#include "store/store.h"

namespace strata::net {
namespace {

using store::Person;
using store::TokenKind;

nlohmann::json to_json(const Person& person) {
  nlohmann::json json{{"id", person.id},
                      {"user", person.name},
                      {"full_name", person.full_name},
                      {"role", std::string(name(person.role))},
                      {"state", person.disabled                             ? "disabled"
                                : person.has_password || person.has_sign_on ? "active"
                                                                            : "invited"},
                      {"created", utc_text(person.created)},
                      {"groups", person.groups}};
  add_color(json, person);
  if (person.last_seen) json["last_seen"] = utc_text(*person.last_seen);
  return json;
}

Result<Response> list_people(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto people = STRATA_TRY(context.store.accounts().all());
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(people.size());
  const auto part = STRATA_TRY(slice_by_name(page, people, context.store, [](const Person& person) {
    return store::NamedId{person.name, person.id.number()};
  }));
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(people[i]));
  Response response = json_response({{"users", std::move(list)}, {"total", total}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<Role> usable_role(const Request& request, std::optional<protocol::Role> requested,
                         Role otherwise) {
  const Role role = requested ? static_cast<Role>(static_cast<int>(*requested)) : otherwise;
  if (role == Role::owner)
    return fail(ErrorCode::invalid, "Only one owner",
                "A server can have only one owner. Choose the role administrator instead.", "role");
  if (role > request.principal->role)
    return fail(ErrorCode::forbidden, "Not allowed", "You cannot assign a role above your own.",
                "role");
  return role;
}

Result<Response> with_invitation(const RouteContext& context, const Person& person, int status) {
  const auto link = context.store.tokens().create_link(TokenKind::invitation, person.name,
                                                       store::kInvitationLifetime);
  if (!link) return tl::unexpected(link.error());
  // Browsers do not send the part after #, so no log contains the secret.
  return json_response({{"path", "/join#" + link->secret},
                        {"expires", utc_text(link->token.expires.value_or(link->token.created))},
                        {"user", to_json(person)}},
                       status)
      .with("Cache-Control", "no-store");
}

Result<Response> invite(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PersonCreate>(request));
  const auto role = STRATA_TRY(usable_role(request, body.role, Role::viewer));
  const auto person = STRATA_TRY(context.store.accounts().create(
      body.user, body.full_name.value_or(""), role,
      ids_of<GroupId>(body.groups.value_or(std::vector<std::int64_t>())), request.user()));
  auto response = with_invitation(context, person, 201);
  if (response) response->with("Location", "/api/v1/users/" + percent_encode(person.name));
  return response;
}

// Returns the account that the caller may change. Users cannot change their own accounts here, so a
// site always has an administrator. The account of the owner cannot be changed here.
Result<Person> somebody_else(const RouteContext& context, const Request& request) {
  auto person = STRATA_TRY(context.store.accounts().find(request.param("user")));
  if (person.name == request.user())
    return fail(ErrorCode::conflict, "Cannot change your own account",
                "You cannot change your own account here. Ask another administrator.");
  if (person.role == Role::owner)
    return fail(ErrorCode::conflict, "Cannot change the owner",
                "Only the owner can change the owner's account.");
  // Prevents an administrator from signing in as another administrator.
  if (person.role == Role::administrator && request.principal->role < Role::owner)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only the owner can change accounts of administrators.");
  return person;
}

Result<Response> change_person(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PersonPatch>(request));
  const auto person = STRATA_TRY(somebody_else(context, request));
  const auto role = STRATA_TRY(usable_role(request, body.role, person.role));
  const store::PersonChange change{body.full_name, body.role ? std::optional(role) : std::nullopt,
                                   body.disabled};
  const auto changed = STRATA_TRY(context.store.accounts().update(person.id, change));
  context.auth.forget();
  if (changed.role != person.role || changed.disabled != person.disabled)
    context.live_sockets.close_user(changed.name, kClosePolicy, "your account was changed");
  return json_response(to_json(changed));
}

Result<Response> delete_person(const RouteContext& context, const Request& request) {
  const auto person = STRATA_TRY(somebody_else(context, request));
  // Disables the account first to prevent further changes under this name.
  const auto out =
      context.store.accounts().update(person.id, {.full_name = {}, .role = {}, .disabled = true});
  if (!out) return tl::unexpected(out.error());
  context.auth.forget();
  context.live_sockets.close_user(person.name, kClosePolicy, "your account was deleted");
  // The journal may not yet contain the last strokes of the user.
  STRATA_TRY(context.rooms.settle());
  STRATA_TRY(context.store.accounts().remove(person.name));
  return empty_response(204);
}

// --- requests from invited users

Result<Person> invited_by(const RouteContext& context, const std::string& invitation) {
  const auto principal = STRATA_TRY(context.store.tokens().find(invitation));
  if (!principal || principal->kind != TokenKind::invitation)
    return fail(ErrorCode::unauthenticated, "Link is not valid",
                "This invitation has already been used or has expired. Ask for a new invitation.",
                "invitation");
  return context.store.accounts().find(principal->user);
}

Result<Response> show_invitation(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::InvitationShow>(request));
  const auto person = STRATA_TRY(invited_by(context, body.invitation));
  return json_response(to_json(person)).with("Cache-Control", "no-store");
}

Result<Response> accept_invitation(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::InvitationAccept>(request));
  STRATA_TRY(check_local_accounts(context));
  const auto invited = invited_by(context, body.invitation);
  if (!invited && invited.error().code == ErrorCode::unauthenticated) {
    const store::ActingAs acting(signing_in(request, "invitation"));
    STRATA_TRY(context.store.audit().failed_sign_in({}, "invitation"));
  }
  const Person person = STRATA_TRY(invited);
  const store::ActingAs acting(signing_in(request, "invitation", person.name));
  STRATA_TRY(store::check_password(body.password, person.name, "password"));
  const auto hash = STRATA_TRY(store::hash_password(body.password));
  const auto session = STRATA_TRY(context.store.accounts().accept_invitation(
      body.invitation, hash, body.full_name, kSessionLifetime, agent_of(request)));
  if (!session)
    return fail(ErrorCode::unauthenticated, "Link is not valid",
                "Somebody used this invitation in the meantime. Ask for a new invitation.",
                "invitation");
  context.auth.forget();
  context.live_sockets.close_user(person.name, kClosePolicy, "the password was changed");
  return signed_in(context, request, *session);
}

}  // namespace

void add_people_routes(Router& router, const RouteContext& context) {
  const auto add = [&](Method method, std::string pattern,
                       Result<Response> (*answer)(const RouteContext&, const Request&),
                       std::optional<Role> role, std::vector<std::string> query = {}) {
    const bool has_body =
        method == Method::patch || (method == Method::post && !pattern.ends_with("/invite"));
    router.add({.method = method,
                .pattern = std::move(pattern),
                .handler = answering([&context, answer](const Request& request) {
                  return answer(context, request);
                }),
                .role = role,
                .query = std::move(query),
                .check = role && method != Method::get ? std::function(check_no_script) : nullptr,
                .body = has_body ? BodyKind::memory : BodyKind::none,
                .max_body = has_body ? context.options.max_json_bytes : 0});
  };
  add(Method::get, "/api/v1/users", list_people, Role::administrator, {"limit", "offset", "after"});
  add(Method::post, "/api/v1/users", invite, Role::administrator);
  add(
      Method::get, "/api/v1/users/{user}",
      [](const RouteContext& of, const Request& request) -> Result<Response> {
        const auto person = STRATA_TRY(of.store.accounts().find(request.param("user")));
        return json_response(to_json(person));
      },
      Role::administrator);
  add(Method::patch, "/api/v1/users/{user}", change_person, Role::administrator);
  add(Method::remove, "/api/v1/users/{user}", delete_person, Role::administrator);
  add(
      Method::post, "/api/v1/users/{user}/invite",
      [](const RouteContext& of, const Request& request) -> Result<Response> {
        const auto person = STRATA_TRY(somebody_else(of, request));
        return with_invitation(of, person, 200);
      },
      Role::administrator);
  add(Method::post, "/api/v1/invitations/show", show_invitation, std::nullopt);
  add(Method::post, "/api/v1/invitations/accept", accept_invitation, std::nullopt);
}

}  // namespace strata::net
