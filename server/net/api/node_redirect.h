#pragma once

#include <optional>

#include "core/error.h"
#include "net/http/http_types.h"

namespace strata::room {
class Rooms;
}

// Requests about a model that another node of the site has (store/nodes/nodes.h).
namespace strata::net {

// Returns the redirection (307) of a request whose path names a model that another node has.
// Returns nothing if this node can answer, and always if the server is alone. Call it after the
// caller was authorized, because the address of a node is not public. May block.
std::optional<Response> redirect_to_owner(room::Rooms& rooms, const Request& request);

// The problem of a request that was accepted here before another node claimed a model. The client
// repeats the request, and is then redirected. A handler may need several models, so the owner of
// one of them need not be the right address.
Error claimed_meanwhile();

}  // namespace strata::net
