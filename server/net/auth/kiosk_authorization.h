#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Sets the role of the request's principal, which is a kiosk, and limits it to the data that kiosks
// may read. 403: not a route for kiosks. 404, as for a missing entity: another model, or a table or
// file that belongs neither to the public part of the model nor to its tour.
Result<void> enter_as_kiosk(const RouteContext& context, Request& request, const Route& route);

// Limit the live connection of a kiosk: the messages that it may send, and those that it receives.
// A kiosk receives no names of people, and nothing about other models.
bool may_send_as_kiosk(const protocol::ClientMessage& message);
std::optional<protocol::ServerMessage> filtered_for_kiosk(const protocol::ServerMessage& message);

}  // namespace strata::net
