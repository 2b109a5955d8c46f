#include "net/http/precondition.h"

#include "net/auth/project_authorization.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {

Result<void> check_precondition(const RouteContext& context, const Request& request,
                                const Route& route) {
  if (!route.needs_version || !request.header("if-match").empty()) return {};
  const auto id = STRATA_TRY(addressed_project(context, request));
  if (!id) return {};
  const auto project = STRATA_TRY(context.store.projects().find(to_string(*id)));
  if (!project.require_if_match) return {};
  return fail(ErrorCode::version_required, "Version missing",
              "The project " + project.name +
                  " requires a version with each change. Read the resource again and send its ETag "
                  "in `If-Match`.",
              "If-Match");
}

}  // namespace strata::net
