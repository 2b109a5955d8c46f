// Sign-in with OpenID Connect. The browser opens these addresses, so failures redirect to the page,
// which shows a text for the code in the query.
#include <algorithm>
#include <exception>
#include <memory>

#include "core/log.h"
#include "core/secret.h"
#include "core/trace.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/audit_trail.h"
#include "net/auth/auth.h"
#include "net/auth/login_throttle.h"
#include "net/auth/sign_on_desk.h"
#include "net/http/origin.h"
#include "net/transport/server_options.h"
#include "sign_on/claims.h"
#include "store/people/audit.h"
#include "store/people/sign_ons.h"
#include "store/store.h"

namespace strata::net {
namespace {

// The page has a text for each of these codes (web-client/src/features/account/sign-on.ts).
constexpr std::string_view kUnknown = "unknown_provider", kDenied = "denied", kExpired = "expired",
                           kRefused = "refused", kNoAccount = "no_account", kDisabled = "disabled",
                           kUnreachable = "unreachable", kBusy = "busy";

constexpr std::size_t kMaxCode = 4096, kMaxShownError = 60;
constexpr std::string_view kWay = "oidc";

struct SignOnRoutes {
  const RouteContext& context;
  SignOnDesk& desk;
  LoginThrottle gate{};
};

Response to_page(std::string_view problem) {
  return empty_response(303)
      .with("Location", "/?sign_in_problem=" + std::string(problem))
      .with("Cache-Control", "no-store");
}

Response unreachable(const sign_on::Provider& provider, const Error& error) {
  log::warning("sign-in with " + provider.id + ": " + error.detail);
  return to_page(kUnreachable);
}

bool is_secure(const SignOnRoutes& routes, const Request& request) {
  return own_origin(request, routes.context.options.allowed_origins).starts_with("https://");
}

std::string redirect_uri(const SignOnRoutes& routes, const Request& request) {
  return own_origin(request, routes.context.options.allowed_origins) + "/sign-in/" +
         request.param("provider") + "/callback";
}

// Returns the path to open after the sign-in. It must be an address of the page on this server:
// browsers read `//host` and `/\host` as addresses of other servers.
Result<std::string> checked_return_to(const Request& request) {
  const std::string path = request.query_or("return_to", "/");
  const bool is_printable =
      std::ranges::all_of(path, [](char c) { return c > ' ' && c < 0x7f && c != '\\'; });
  if (path.starts_with('/') && !path.starts_with("//") && is_printable &&
      path.size() <= store::SignOns::kMaxReturnTo && !path.starts_with("/api/") &&
      !path.starts_with("/sign-in/") && !path.starts_with("/login"))
    return path;
  return fail(ErrorCode::invalid, "Invalid address",
              "`return_to` must be the path of a page of this server, such as /models/7.",
              "return_to");
}

Response begin_sign_on(SignOnRoutes& routes, const Request& request) {
  sign_on::Client& client = *routes.desk.find(request.param("provider"));
  const auto return_to = checked_return_to(request);
  if (!return_to) return problem_response(return_to.error());
  const auto handshake = sign_on::Handshake::make();
  const auto url = client.authorization_url(redirect_uri(routes, request), handshake);
  if (!url) return unreachable(client.provider(), url.error());
  const std::string browser = random_token();
  const auto begun = routes.context.store.sign_ons().begin(
      handshake.state, browser,
      {client.provider().id, handshake.nonce, handshake.code_verifier, *return_to},
      kSignInLifetime);
  if (!begun) return to_page(kBusy);
  return empty_response(303)
      .with("Location", *url)
      .with("Set-Cookie", Authenticator::set_sign_in_cookie(browser, is_secure(routes, request)))
      .with("Cache-Control", "no-store");
}

// Writes the failure to the audit log.
Response refused_sign_on(const SignOnRoutes& routes, const std::string& user,
                         std::string_view problem) {
  if (const auto audited = routes.context.store.audit().failed_sign_in(user, kWay); !audited)
    return problem_response(audited.error());
  return to_page(problem);
}

// Returns a provider's error code for the log, without characters that no error code contains.
std::string shown_error(const std::string& error) {
  std::string shown = error.substr(0, kMaxShownError);
  std::erase_if(shown, [](char c) { return !((c >= 'a' && c <= 'z') || c == '_'); });
  return shown;
}

Response open_session(SignOnRoutes& routes, const Request& request,
                      const sign_on::Provider& provider, const nlohmann::json& claims,
                      const std::string& return_to) {
  using Outcome = store::SignedOn::Outcome;
  const auto rights = sign_on::rights_of(provider, claims);
  store::SignOn sign_on;
  sign_on.issuer = provider.issuer;
  sign_on.subject = sign_on::claim_text(claims, "sub");
  sign_on.name = sign_on::claim_text(claims, provider.user_name_claim);
  sign_on.full_name = sign_on::claim_text(claims, "name");
  sign_on.may_create = rights.may_create;
  sign_on.new_role = provider.role;
  sign_on.role = rights.role;
  sign_on.groups = rights.groups;
  const auto done =
      routes.context.store.sign_ons().sign_in(sign_on, kSessionLifetime, agent_of(request));
  if (!done) {
    log::warning("sign-in with " + provider.id + ": " + done.error().detail);
    return to_page(kBusy);
  }
  if (done->outcome == Outcome::no_account)
    return refused_sign_on(routes, sign_on.name, kNoAccount);
  if (done->outcome == Outcome::disabled) return refused_sign_on(routes, done->user, kDisabled);
  for (const std::string& group : done->skipped_groups)
    log::warning("sign-in with " + provider.id + ": the group " + group +
                 " does not exist or is full");
  if (done->changed) roles_changed(routes.context, {done->user});
  return empty_response(303)
      .with("Location", return_to)
      .with("Set-Cookie", Authenticator::set_cookie(done->session, is_secure(routes, request)))
      .with("Cache-Control", "no-store");
}

Response finish_sign_on(SignOnRoutes& routes, const Request& request) {
  sign_on::Client& client = *routes.desk.find(request.param("provider"));
  const sign_on::Provider& provider = client.provider();
  const std::string state = request.query_or("state", {});
  const auto pending = routes.context.store.sign_ons().take(
      state, Authenticator::sign_in_secret_of(request, is_secure(routes, request)));
  if (!pending) return problem_response(pending.error());
  if (!*pending) return refused_sign_on(routes, {}, kExpired);
  const auto answer = [&]() -> Response {
    if ((*pending)->provider != provider.id) return refused_sign_on(routes, {}, kRefused);
    const std::string error = request.query_or("error", {}), code = request.query_or("code", {});
    if (error == "access_denied") return to_page(kDenied);
    if (!error.empty() || code.empty() || code.size() > kMaxCode) {
      log::info("sign-in with " + provider.id + ": the provider refused: " + shown_error(error));
      return refused_sign_on(routes, {}, kRefused);
    }
    sign_on::Callback callback{code, std::nullopt};
    if (request.query.contains("iss")) callback.issuer = request.query.at("iss");
    const auto claims = client.claims(callback, redirect_uri(routes, request),
                                      {state, (*pending)->nonce, (*pending)->code_verifier});
    if (!claims && claims.error().code == ErrorCode::unauthenticated) {
      log::info("sign-in with " + provider.id + ": " + claims.error().detail);
      return refused_sign_on(routes, {}, kRefused);
    }
    if (!claims) return unreachable(provider, claims.error());
    return open_session(routes, request, provider, *claims, (*pending)->return_to);
  };
  return answer().with("Set-Cookie",
                       Authenticator::clear_sign_in_cookie(is_secure(routes, request)));
}

// Returns a handler that runs on a thread of the desk, because it may wait for the provider.
Handler at_desk(const std::shared_ptr<SignOnRoutes>& routes,
                Response (*work)(SignOnRoutes&, const Request&)) {
  return [routes, work](const Request& request, const Respond& respond) {
    const std::string provider = request.param("provider");
    if (!routes->desk.find(provider)) return respond(to_page(kUnknown));
    if (!routes->gate.pass(address_of(request), {})) return respond(to_page(kBusy));
    const auto copy = std::make_shared<const Request>(request);
    const bool is_posted = routes->desk.post([routes, work, copy, provider, respond] {
      const TraceScope traced(copy->trace.trace);
      auto actor = signing_in(*copy, std::string(kWay));
      actor.provider = provider;
      const store::ActingAs acting(std::move(actor));
      try {
        respond(work(*routes, *copy));
      } catch (const std::exception& error) {
        log::error("sign-in with " + provider + " failed: " + error.what());
        respond(to_page(kUnreachable));
      }
    });
    if (!is_posted) respond(to_page(kBusy));
  };
}

Response list_ways(const RouteContext& context) {
  nlohmann::json providers = nlohmann::json::array();
  for (const sign_on::Provider& provider : context.options.sign_on_providers)
    providers.push_back({{"id", provider.id}, {"name", provider.name}});
  return json_response(
      {{"providers", std::move(providers)}, {"local_accounts", context.options.local_accounts}});
}

}  // namespace

void add_sign_on_routes(Router& router, const RouteContext& context, SignOnDesk& desk) {
  const std::shared_ptr<SignOnRoutes> routes(new SignOnRoutes{context, desk});
  router.add({.method = Method::get,
              .pattern = "/api/v1/sign-in/providers",
              .handler = answering(
                  [&context](const Request&) -> Result<Response> { return list_ways(context); }),
              .role = std::nullopt});
  router.add({.method = Method::get,
              .pattern = "/sign-in/{provider}",
              .handler = at_desk(routes, begin_sign_on),
              .role = std::nullopt,
              .query = {"return_to"}});
  router.add({.method = Method::get,
              .pattern = "/sign-in/{provider}/callback",
              .handler = at_desk(routes, finish_sign_on),
              .role = std::nullopt,
              .any_query = true});  // providers add parameters
}

}  // namespace strata::net
