#pragma once

#include <memory>
#include <optional>

#include "net/api/route_help.h"
#include "room/room.h"

namespace strata::net {

// Returns a request's `at`: a sequence of the model, or a time, which selects its last edit.
std::optional<protocol::At> as_of(const Request& request);  // the query parameter
// Converts it to a sequence; nothing: now. Refuses (422, `at`) other text, and a sequence that does
// not exist yet.
Result<std::optional<std::int64_t>> find_sequence(const RouteContext& context,
                                                  const room::Room& room,
                                                  const std::optional<protocol::At>& at);

// The parts of a question about one layer: the model and the layer of the path, as visible to the
// role of the request, and the query's `at`.
struct LayerQuery {
  std::shared_ptr<room::Room> room;
  Layer layer;
  std::optional<std::int64_t> at;  // a sequence of the model; nothing: now
  std::int64_t sequence = 0;       // of the state that the answer shows

  static Result<LayerQuery> from(const RouteContext& context, const Request& request);
};

}  // namespace strata::net
