#pragma once

#include <memory>
#include <optional>

#include "net/api/route_help.h"
#include "room/room.h"

namespace strata::net {

// What a question's `at` says: a sequence of the model, or a time, whose last edit counts.
std::optional<protocol::At> as_of(const Request& request);  // the query parameter
// As a sequence; nothing: now. Refused (422, `at`): what is neither, and a sequence that is not
// there yet.
Result<std::optional<std::int64_t>> find_sequence(const RouteContext& context,
                                                  const room::Room& room,
                                                  const std::optional<protocol::At>& at);

// What a question about one layer names: the model and the layer of the path, as the role of the
// request sees them, and the query's `at`.
struct LayerQuery {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::optional<std::int64_t> at;  // a sequence of the model; nothing: now
  std::int64_t sequence = 0;       // that the answer gives

  static Result<LayerQuery> from(const RouteContext& context, const Request& request);
};

}  // namespace strata::net
