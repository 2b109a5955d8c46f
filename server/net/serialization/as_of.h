#pragma once

#include <memory>
#include <optional>

#include "net/api/route_help.h"
#include "room/room.h"

namespace strata::net {

// Returns the query parameter `at`. It is a sequence of the model, or a time, which selects the
// last edit before it.
std::optional<protocol::At> as_of(const Request& request);  // empty: now
// Converts `at` to a sequence. Returns nothing for the current state. Refuses (422, `at`) invalid
// text and a sequence that does not exist yet.
Result<std::optional<std::int64_t>> find_sequence(const RouteContext& context,
                                                  const room::Room& room,
                                                  const std::optional<protocol::At>& at);

// The common parts of a request about one layer: the room, the layer as visible to the role, and
// the query parameter `at`.
struct LayerQuery {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::optional<std::int64_t> at;  // sequence of the model; empty: now
  std::int64_t sequence = 0;       // sequence of the state in the response

  static Result<LayerQuery> from(const RouteContext& context, const Request& request);
};

}  // namespace strata::net
