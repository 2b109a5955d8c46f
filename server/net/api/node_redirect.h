#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.h"
#include "net/http/http_types.h"

namespace strata::room {
class Rooms;
}

// Requests about a model that another node of the site has (store/nodes/nodes.h).
namespace strata::net {

struct RouteContext;

// Returns the redirection (307) of a request whose path names a model that another node has.
// Returns nothing if this node can answer, or if the server runs alone. Call it after the caller
// was authorized, because the address of a node is not public. May block.
std::optional<Response> redirect_to_owner(room::Rooms& rooms, const Request& request);

// Returns `unavailable` if the path names a model and this node has no lease, so that a proxy or a
// client goes to another node at once. Call it before anything that uses the database: a database
// that is cut off neither answers nor closes its connections. Does not block.
Result<void> check_has_lease(const RouteContext& context, const Request& request);

// Returns `moved`, with the address of the node, if another node runs the job in the path. Call it
// before the project of the job is looked up, because only that node lists the job. May block.
Result<void> check_job_is_here(const RouteContext& context, const Request& request);

// Returns the response to a request whose handler needed a model that the node at `node` has. The
// path does not name this model, or the node has just claimed it. `target` is the request's target.
// A request is redirected in this way only once, because it may need models of several nodes. If
// `again` is true or `node` is empty, returns 503, and the client repeats the request later.
Response redirected_by_handler(std::string_view node, std::string_view target, bool again);

}  // namespace strata::net
