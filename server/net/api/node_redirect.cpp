#include "net/api/node_redirect.h"

#include "app/nodes/node_lease.h"
#include "jobs/job_queue.h"
#include "net/auth/project_authorization.h"
#include "net/transport/server_options.h"
#include "room/rooms.h"
#include "store/nodes/nodes.h"
#include "store/store.h"

namespace strata::net {
namespace {

std::string located(std::string_view node, std::string_view target, bool marked) {
  std::string location(node);
  location.append(target);
  if (marked)
    location.append(target.find('?') == std::string_view::npos ? "?" : "&").append(kMovedMark);
  return location;
}

Response redirection(std::string location) {
  Response response = problem_response(moved_to({}));
  response.with("Location", std::move(location));
  return response;
}

}  // namespace

std::optional<Response> redirect_to_owner(room::Rooms& rooms, const Request& request) {
  const auto model = request.params.find("model");
  if (model == request.params.end()) return std::nullopt;
  const auto owner = rooms.elsewhere(model->second);
  if (!owner) return problem_response(owner.error());
  if (!*owner) return std::nullopt;
  return redirection(located(**owner, request.target, request.was_moved));
}

Result<void> check_has_lease(const RouteContext& context, const Request& request) {
  const app::NodeLease* lease = context.options.lease;
  if (!lease || lease->holds() || !request.params.contains("model")) return {};
  return fail(ErrorCode::unavailable, "Node not available",
              "This node has lost its connection to the database, so it cannot open models. Try "
              "again in a moment.");
}

Result<void> check_job_is_here(const RouteContext& context, const Request& request) {
  const app::NodeLease* lease = context.options.lease;
  if (!lease || !request.params.contains("job")) return {};
  const auto id = id_of<JobId>(request, "job");
  if (!id || context.jobs.status(*id)) return {};
  auto node = STRATA_TRY(context.store.nodes().node_of_job(*id, lease->node().id));
  if (node) return tl::unexpected(moved_to(std::move(*node)));
  return {};
}

Response redirected_by_handler(std::string_view node, std::string_view target, bool again) {
  if (node.empty() || again)
    return problem_response(
        {ErrorCode::unavailable,
         "Model is at another node",
         "Another node of the site has a model that this request needs, or the models that it needs "
         "are at different nodes. Send the request again in a few seconds.",
         {}});
  return redirection(located(node, target, true));
}

}  // namespace strata::net
