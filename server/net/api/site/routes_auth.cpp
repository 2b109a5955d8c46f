// Sign-in, sign-out, and the changes that users can make to their own accounts.
#include <memory>

#include "core/text/timestamp.h"
#include "core/text/utf8.h"
#include "domain/people/role.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/audit_trail.h"
#include "net/auth/auth.h"
#include "net/auth/login_throttle.h"
#include "net/auth/project_authorization.h"
#include "net/http/origin.h"
#include "net/http/page.h"
#include "net/live/close_codes.h"
#include "net/live/live_sockets.h"
#include "net/serialization/people_serialization.h"
#include "net/transport/server_options.h"
#include "store/content/projects.h"
#include "store/people/accounts.h"
#include "store/people/audit.h"
#include "store/people/password.h"
#include "store/people/people.h"
#include "store/people/tokens.h"
#include "store/store.h"

namespace strata::net {

Result<Response> who_is_signed_in(const RouteContext& context, const std::string& user, Role role) {
  const auto person = context.store.accounts().find(user);
  if (!person && person.error().code == ErrorCode::not_found)
    return fail(ErrorCode::unauthenticated, "Not signed in",
                "Somebody closed this account in the meantime.");
  if (!person) return tl::unexpected(person.error());
  nlohmann::json me{{"user", person->name},
                    {"full_name", person->full_name},
                    {"role", std::string(name(role))},
                    {"has_password", person->has_password}};
  if (person->has_sign_on) me["has_sign_on"] = true;
  add_color(me, *person);
  return json_response(me);
}

Result<Response> signed_in(const RouteContext& context, const Request& request,
                           const std::string& session) {
  auto principal = STRATA_TRY(context.auth.identify_token(session));
  if (!principal)
    return fail(ErrorCode::unauthenticated, "Not signed in",
                "Somebody closed this account in the meantime.");
  auto response = who_is_signed_in(context, principal->user, principal->role);
  if (response)
    response->with("Set-Cookie", Authenticator::set_cookie(session, needs_secure_cookie(request)));
  return response;
}

Result<void> check_no_script(const Request& request) {
  if (!request.principal->is_script) return {};
  return fail(ErrorCode::forbidden, "Not allowed for scripts",
              "A token for scripts cannot change accounts. Sign in with your user name and "
              "password.");
}

Result<void> check_local_accounts(const RouteContext& context) {
  if (context.options.local_accounts) return {};
  return fail(ErrorCode::forbidden, "Passwords are switched off",
              "This site does not use passwords. Sign in with one of the buttons on the sign-in "
              "page.",
              "password");
}

std::string visible_name(const Request& request, const std::string& user) {
  return request.principal->kiosk ? std::string() : user;
}

std::string agent_of(const Request& request) {
  const std::string_view agent = request.header("user-agent");
  return is_utf8(agent) ? mended_utf8(agent.substr(0, 390)) : std::string();
}

namespace {

using store::TokenKind;

// Writes the failure to the audit log unless the server itself failed.
tl::unexpected<Error> failed_sign_in(const RouteContext& context, const std::string& user,
                                     std::string_view way, const Error& why) {
  if (why.code == ErrorCode::unauthenticated || why.code == ErrorCode::forbidden)
    if (auto audited = context.store.audit().failed_sign_in(user, way); !audited)
      return tl::unexpected(audited.error());
  return tl::unexpected(why);
}

Result<Response> sign_in_by_link(const RouteContext& context, LoginThrottle& gate,
                                 const Request& request) {
  STRATA_TRY(gate.pass(address_of(request), {}));
  const store::ActingAs acting(signing_in(request, "link"));
  auto session = context.auth.session_for_link(request.query_or("link", {}), agent_of(request));
  if (!session) return failed_sign_in(context, {}, "link", session.error());
  gate.was_right(address_of(request), {});
  return empty_response(303)
      .with("Location", "/")
      .with("Set-Cookie", Authenticator::set_cookie(*session, needs_secure_cookie(request)))
      .with("Cache-Control", "no-store");
}

Result<Response> sign_in(const RouteContext& context, LoginThrottle& gate, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::Login>(request));
  if (!body.token) STRATA_TRY(check_local_accounts(context));
  const std::string user = body.user.value_or(""), address = address_of(request);
  STRATA_TRY(gate.pass(address, user));
  const std::string way = body.token ? "token" : "password";
  const store::ActingAs acting(signing_in(request, way));
  const auto session =
      body.token ? context.auth.session_for_token(*body.token, agent_of(request))
                 : context.auth.session_for_password(user, *body.password, agent_of(request));
  if (!session) return failed_sign_in(context, user, way, session.error());
  gate.was_right(address, user);
  return signed_in(context, request, *session);
}

Result<Response> sign_out(const RouteContext& context, const Request& request) {
  // A token for scripts stays valid after a sign-out. Users revoke it explicitly.
  if (request.principal->by_cookie) {
    const std::string session = Authenticator::secret_of(request);
    STRATA_TRY(context.auth.end_session(session));
    context.live_sockets.close_those_of(session, kClosePolicy, "signed out");
  }
  return empty_response(204).with("Set-Cookie",
                                  Authenticator::clear_cookie(needs_secure_cookie(request)));
}

Result<Response> change_me(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::MePatch>(request));
  const auto person = STRATA_TRY(context.store.accounts().find(request.user()));
  STRATA_TRY(context.store.accounts().update(
      person.id, {.full_name = body.full_name, .role = {}, .disabled = {}}));
  return who_is_signed_in(context, request.user(), request.principal->role);
}

Result<Response> change_password(const RouteContext& context, LoginThrottle& gate,
                                 const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::PasswordChange>(request));
  STRATA_TRY(check_local_accounts(context));
  STRATA_TRY(store::check_password(body.password, request.user(), "password"));
  const auto hash = STRATA_TRY(context.store.accounts().password_of(request.user()));
  if (hash.empty()) {
    // Without a password, the server cannot check that the account's user is at this browser.
    const auto me = STRATA_TRY(context.store.accounts().find(request.user()));
    if (me.has_sign_on)
      return fail(ErrorCode::forbidden, "Account without a password",
                  "You sign in with a provider. To choose a password, too, ask an administrator "
                  "for a link.",
                  "password");
  } else {
    // Applies the limit for sign-ins, because a person at another user's browser could also guess
    // the password.
    STRATA_TRY(gate.pass(address_of(request), request.user()));
    const auto fits =
        body.current ? store::password_fits(hash, *body.current) : Result<bool>(false);
    if (!fits) return tl::unexpected(fits.error());
    if (!*fits) {
      // A wrong password is also a failed sign-in, even in a browser where the user is signed in.
      STRATA_TRY(context.store.audit().failed_sign_in(request.user(), "password"));
      return fail(ErrorCode::invalid, "Wrong current password",
                  "The current password is wrong. Enter it again.", "current");
    }
    gate.was_right(address_of(request), request.user());
  }
  const auto chosen = STRATA_TRY(store::hash_password(body.password));
  STRATA_TRY(
      context.store.accounts().set_password(request.user(), chosen, request.principal->secret));
  context.auth.forget();
  context.live_sockets.close_user(request.user(), kClosePolicy, "the password was changed");
  return empty_response(204);
}

std::optional<std::string> text_of(
    const std::optional<std::chrono::system_clock::time_point>& time) {
  return time ? std::optional(utc_text(*time)) : std::nullopt;
}

nlohmann::json session_json(const store::Token& token, TokenId current) {
  nlohmann::json json{{"id", token.id},
                      {"created", utc_text(token.created)},
                      {"expires", utc_text(token.expires.value_or(token.created))},
                      {"agent", token.label},
                      {"current", token.id == current}};
  if (const auto used = text_of(token.last_used)) json["last_used"] = *used;
  return json;
}

nlohmann::json token_json(const store::Token& token) {
  nlohmann::json json{{"id", token.id},
                      {"name", token.label},
                      {"role", std::string(name(token.role))},
                      {"created", utc_text(token.created)}};
  if (token.project) json["project"] = *token.project;
  if (const auto expires = text_of(token.expires)) json["expires"] = *expires;
  if (const auto used = text_of(token.last_used)) json["last_used"] = *used;
  return json;
}

template <class Write>
Result<Response> list_of(const RouteContext& context, const Request& request, TokenKind kind,
                         const char* member, Write write) {
  const auto page = STRATA_TRY(page_of(request, kMaxPage));
  const auto tokens = STRATA_TRY(context.store.tokens().of_user(request.user(), kind));
  const auto part = slice_by(
      page, tokens, [](const store::Token& token) { return NumberKey{-token.id.number()}; });
  if (!part) return tl::unexpected(part.error());
  nlohmann::json list = nlohmann::json::array();
  for (std::size_t i = part->begin; i < part->end; ++i) list.push_back(write(tokens[i]));
  Response response = json_response({{member, std::move(list)}, {"total", tokens.size()}});
  add_page_links(response, request, page, part->last);
  return response;
}

Result<Response> end_one(const RouteContext& context, const Request& request, TokenKind kind,
                         const std::string& param) {
  const auto id =
      parse_integer(request.param(param), 1, std::numeric_limits<std::int64_t>::max(), param);
  if (!id) return tl::unexpected(id.error());
  STRATA_TRY(context.store.tokens().revoke(request.user(), kind, TokenId(*id)));
  context.auth.forget();
  context.live_sockets.close_user(request.user(), kClosePolicy, "a session ended");
  return empty_response(204);
}

Result<Response> end_others(const RouteContext& context, const Request& request) {
  auto ended = context.store.tokens().revoke_all(request.user(), TokenKind::session,
                                                 request.principal->secret);
  if (!ended) return tl::unexpected(ended.error());
  context.auth.forget();
  context.live_sockets.close_user(request.user(), kClosePolicy, "other sessions ended");
  return empty_response(204);
}

Result<Response> create_token(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ScriptTokenCreate>(request));
  Role own = request.principal->roles.highest();
  Role role = own;
  std::optional<ProjectId> only;
  if (body.project) {
    STRATA_TRY(check_seen(context, request, *body.project, "project"));
    auto project = context.store.projects().find(*body.project);
    if (!project) {
      project.error().field = "project";
      return tl::unexpected(project.error());
    }
    only = project->id;
    own = request.principal->roles.in(*only);
    role = std::min(own, Role::curator);
  }
  if (body.role) role = static_cast<Role>(static_cast<int>(*body.role));
  if (role > own)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Your role " + std::string(only ? "in this project " : "") + "is " +
                    std::string(name(own)) + ". A token cannot have a higher role than you.",
                "role");
  const auto made =
      context.store.tokens().create(TokenKind::script, request.user(), role,
                                    std::chrono::hours(24 * body.days), body.name, {}, only);
  if (!made) return tl::unexpected(made.error());
  return json_response({{"secret", made->secret}, {"token", token_json(made->token)}}, 201)
      .with("Cache-Control", "no-store");
}

}  // namespace

void add_auth_routes(Router& router, const RouteContext& context) {
  auto gate = std::make_shared<LoginThrottle>();
  // For changes that users make to their own accounts.
  const auto add = [&](Method method, const std::string& pattern, auto answer,
                       const std::vector<std::string>& query = {}) {
    const bool has_body = method == Method::post || method == Method::patch;
    router.add({.method = method,
                .pattern = pattern,
                .handler = answering(answer),
                .role = Role::guest,
                .query = query,
                .check = check_no_script,
                .body = has_body ? BodyKind::memory : BodyKind::none,
                .max_body = has_body ? context.options.max_json_bytes : 0});
  };

  router.add({.method = Method::get,
              .pattern = "/login",
              .handler = answering([&context, gate](const Request& request) {
                return sign_in_by_link(context, *gate, request);
              }),
              .role = std::nullopt,
              .query = {"link"}});
  router.add({.method = Method::post,
              .pattern = "/api/v1/login",
              .handler = answering([&context, gate](const Request& request) {
                return sign_in(context, *gate, request);
              }),
              .role = std::nullopt,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
  router.add({.method = Method::post,
              .pattern = "/api/v1/logout",
              .handler = answering(
                  [&context](const Request& request) { return sign_out(context, request); }),
              .role = Role::guest});
  router.add({.method = Method::get,
              .pattern = "/api/v1/me",
              .handler = answering([&context](const Request& request) {
                return who_is_signed_in(context, request.user(), request.principal->role);
              }),
              .role = Role::guest});
  add(Method::patch, "/api/v1/me",
      [&context](const Request& request) { return change_me(context, request); });
  add(Method::post, "/api/v1/me/password", [&context, gate](const Request& request) {
    return change_password(context, *gate, request);
  });
  const std::vector<std::string> paged{"limit", "offset", "after"};
  const auto list_sessions = [&context](const Request& request) {
    return list_of(
        context, request, TokenKind::session, "sessions",
        [&](const store::Token& token) { return session_json(token, request.principal->secret); });
  };
  add(Method::get, "/api/v1/me/sessions", list_sessions, paged);
  add(Method::remove, "/api/v1/me/sessions",
      [&context](const Request& request) { return end_others(context, request); });
  add(Method::remove, "/api/v1/me/sessions/{session}", [&context](const Request& request) {
    return end_one(context, request, TokenKind::session, "session");
  });
  const auto list_tokens = [&context](const Request& request) {
    return list_of(context, request, TokenKind::script, "tokens", token_json);
  };
  add(Method::get, "/api/v1/me/tokens", list_tokens, paged);
  add(Method::post, "/api/v1/me/tokens",
      [&context](const Request& request) { return create_token(context, request); });
  add(Method::remove, "/api/v1/me/tokens/{token}", [&context](const Request& request) {
    return end_one(context, request, TokenKind::script, "token");
  });
}

}  // namespace strata::net
