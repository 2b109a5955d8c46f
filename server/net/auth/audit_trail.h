#pragma once

#include "net/http/http_types.h"
#include "store/pg/acting.h"

namespace strata::net {

struct RouteContext;

// Returns the sender of the request for the audit log.
store::Actor actor_of(const Request& request);
// Returns the actor of a sign-in. Before its success, the user is not known. `way` is "password",
// "token", "link", "invitation" or "oidc".
store::Actor signing_in(const Request& request, std::string way, std::string user = {});

// Writes a response with a file that browsers save (Content-Disposition: attachment), or with the
// first part of one, to the audit log. Ignores other responses. The thread must act as the sender
// (store::ActingAs). If this function fails, do not send the response. Blocks.
Result<void> audit_export(const RouteContext& context, const Request& request,
                          const Response& response);

}  // namespace strata::net
