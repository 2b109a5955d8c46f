#include "net/api/node_redirect.h"

#include "room/rooms.h"

namespace strata::net {
namespace {

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
  return redirection(**owner + request.target);
}

Response redirected_by_handler(std::string_view node, std::string_view target, bool again) {
  if (node.empty() || again)
    return problem_response(
        {ErrorCode::unavailable,
         "Model is at another node",
         "Another node of the site has a model that this request needs, or the models that it needs "
         "are at different nodes. Send the request again in a few seconds.",
         {}});
  std::string location(node);
  location.append(target).append(target.find('?') == std::string_view::npos ? "?" : "&");
  return redirection(location.append(kMovedParameter).append("=1"));
}

}  // namespace strata::net
