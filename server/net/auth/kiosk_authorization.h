#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// What a kiosk may read, and nothing else: sets the role of the request's principal, which is one.
// 403: it is no question that kiosks ask. 404, as if it was not there: another model, or a table or
// file that has nothing to do with what is public of the model, or with its tour.
Result<void> enter_as_kiosk(const RouteContext& context, Request& request, const Route& route);

// Of what a client sends over the live connection, what a kiosk may; and of what is told there,
// what it is told: of no person, and of nothing beside its model.
bool may_send_as_kiosk(const protocol::ClientMessage& message);
std::optional<protocol::ServerMessage> told_to_kiosk(const protocol::ServerMessage& message);

}  // namespace strata::net
