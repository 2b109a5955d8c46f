#include "net/api/node_redirect.h"

#include "room/rooms.h"

namespace strata::net {

std::optional<Response> redirect_to_owner(room::Rooms& rooms, const Request& request) {
  const auto model = request.params.find("model");
  if (model == request.params.end()) return std::nullopt;
  const auto owner = rooms.elsewhere(model->second);
  if (!owner) return problem_response(owner.error());
  if (!*owner) return std::nullopt;
  Response response = problem_response(moved_to(**owner));
  response.with("Location", **owner + request.target);
  return response;
}

Error claimed_meanwhile() {
  return {ErrorCode::unavailable,
          "Model is moving",
          "Another node of the site is taking over a model that this request needs. Send the "
          "request again.",
          {}};
}

}  // namespace strata::net
