#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Sets the role of the request's principal, which is a kiosk, and limits it to the data that kiosks
// may read. Returns 403 if the route is not for kiosks. Returns 404, as for a missing entity, for
// another model. Returns 404 also for a table or file that belongs neither to the public part of
// the model nor to the kiosk's tour.
Result<void> enter_as_kiosk(const RouteContext& context, Request& request, const Route& route);

// Limit the messages that a kiosk may send over its live connection, and the messages that it
// receives. A kiosk receives no user names and no messages about other models.
bool may_send_as_kiosk(const protocol::ClientMessage& message);
std::optional<protocol::ServerMessage> filtered_for_kiosk(const protocol::ServerMessage& message);

}  // namespace strata::net
