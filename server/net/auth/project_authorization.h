#pragma once

#include "core/ids.h"
#include "core/no_such.h"
#include "net/api/route_help.h"

namespace strata::net {

// Sets the role of the request's principal to the caller's role in the addressed project. The path
// addresses the project by a model, table, attachment, comment, job or kiosk. If `in_query` is
// true, the query parameter `project` (default: `default`) names the project. Returns 404, as for a
// missing entity, if the caller has no role in the project.
Result<void> enter_project(const RouteContext& context, Request& request, bool in_query);

// Returns the addressed project, regardless of the caller's role. Returns nothing if the address
// belongs to no project or the entity does not exist.
Result<std::optional<ProjectId>> addressed_project(const RouteContext& context,
                                                   const Request& request);
// Returns the number in the path parameter `param`. Returns 404 if it cannot be an id.
Result<std::int64_t> number_of(const Request& request, const std::string& param);
template <class Id>
Result<Id> id_of(const Request& request, const std::string& param) {
  return Id(STRATA_TRY(number_of(request, param)));
}

// Checks that the caller can see the project. Otherwise returns 404 at `field`.
Result<void> check_seen(const RouteContext& context, const Request& request,
                        const std::string& project, const std::string& field);

}  // namespace strata::net
