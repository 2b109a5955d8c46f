#pragma once

#include "core/ids.h"
#include "core/no_such.h"
#include "net/api/route_help.h"

namespace strata::net {

// What who asks may do where the address leads: sets the role of the request's principal to theirs
// in the project of the model, table, attachment, comment, job or kiosk that the address names, or
// in that of the query's `project` (absent: `default`) where `in_query`. 404, as if it was not
// there: they have none in it.
Result<void> enter_project(const RouteContext& context, Request& request, bool in_query);

// That project, whatever who asks may do; nothing: the address leads into none, or what it names is
// not there.
Result<std::optional<ProjectId>> addressed_project(const RouteContext& context,
                                                   const Request& request);
// The number in the path's `param`; 404 where it can be nobody's.
Result<std::int64_t> number_of(const Request& request, const std::string& param);
template <class Id>
Result<Id> id_of(const Request& request, const std::string& param) {
  return Id(STRATA_TRY(number_of(request, param)));
}

// That who asks may see the project; otherwise 404 at `field`.
Result<void> check_seen(const RouteContext& context, const Request& request,
                        const std::string& project, const std::string& field);

}  // namespace strata::net
