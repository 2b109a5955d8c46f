#include <memory>
#include <mutex>

#include "net/origin.h"
#include "net/routes.h"
#include "net/token_bucket.h"

namespace strata::net {
namespace {

constexpr double kLoginsPerSecond = 5;
constexpr double kLoginBurst = 20;

// Guards against guessing, for all connections together.
class LoginGate {
 public:
  Result<void> pass() {
    std::lock_guard lock(mutex_);
    if (bucket_.take()) return {};
    return fail(429, "Too many sign-ins", "Wait a second and try again.");
  }

 private:
  std::mutex mutex_;
  TokenBucket bucket_{kLoginsPerSecond, kLoginBurst};
};

// Through a proxy that speaks https: then the cookie must not travel without it.
bool came_by_https(const Request& request) {
  return request.header("x-forwarded-proto") == "https" || request.header("origin").starts_with("https://");
}

Response me(const Principal& principal) {
  return json_response({{"user", principal.user}, {"role", std::string(name(principal.role))}});
}

}  // namespace

void add_auth_routes(Router& router, const RouteContext& context) {
  auto gate = std::make_shared<LoginGate>();

  router.add({.method = Method::get,
              .pattern = "/login",
              .handler = answering([&context, gate](const Request& request) -> Result<Response> {
                if (auto free = gate->pass(); !free) return tl::unexpected(free.error());
                auto session = context.auth.session_for_link(request.query_or("link", {}));
                if (!session) return tl::unexpected(session.error());
                return empty_response(303)
                    .with("Location", "/")
                    .with("Set-Cookie", Authenticator::set_cookie(*session, came_by_https(request)))
                    .with("Cache-Control", "no-store");
              }),
              .role = std::nullopt,
              .query = {"link"}});

  router.add(
      {.method = Method::post,
       .pattern = "/api/v1/login",
       .handler = answering([&context, gate](const Request& request) -> Result<Response> {
         if (auto free = gate->pass(); !free) return tl::unexpected(free.error());
         auto asked = body_of<protocol::Login>(request);
         if (!asked) return tl::unexpected(asked.error());
         auto session = context.auth.session_for_token(asked->token);
         if (!session) return tl::unexpected(session.error());
         auto principal = context.auth.identify_token(*session);
         if (!principal) return tl::unexpected(principal.error());
         return me(principal->value()).with("Set-Cookie", Authenticator::set_cookie(*session, came_by_https(request)));
       }),
       .role = std::nullopt,
       .body = BodyKind::memory,
       .max_body = context.options.max_json_bytes});

  router.add({.method = Method::post,
              .pattern = "/api/v1/logout",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                // A script's token stays valid: it is revoked by name, not by using it here.
                if (request.principal->by_cookie) {
                  const std::string session = Authenticator::secret_of(request);
                  auto ended = context.auth.end_session(session);
                  if (!ended) return tl::unexpected(ended.error());
                  context.live_sockets.close_those_of(session, kClosePolicy, "signed out");
                }
                return empty_response(204).with("Set-Cookie", Authenticator::clear_cookie(came_by_https(request)));
              })});

  router.add({.method = Method::get,
              .pattern = "/api/v1/me",
              .handler = answering([](const Request& request) -> Result<Response> { return me(*request.principal); })});
}

}  // namespace strata::net
