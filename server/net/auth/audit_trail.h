#pragma once

#include "net/http/http_types.h"
#include "store/pg/acting.h"

namespace strata::net {

struct RouteContext;

// Returns the sender of the request, as the audit log names it.
store::Actor actor_of(const Request& request);
// Returns the actor of a sign-in, whose user is not known before it succeeds. `way` is "password",
// "token", "link", "invitation" or "oidc".
store::Actor signing_in(const Request& request, std::string way, std::string user = {});

// Writes a response with a file that browsers save (Content-Disposition: attachment), or with the
// first part of one, to the audit log. Ignores other responses. The thread must act as the sender
// (store::ActingAs). If this fails, the response must not be sent. Blocks.
Result<void> audit_export(const RouteContext& context, const Request& request,
                          const Response& response);

}  // namespace strata::net
