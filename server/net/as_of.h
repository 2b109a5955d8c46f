#pragma once

#include <optional>

#include "net/routes.h"

namespace strata::net {

// What a question's `at` says: a sequence of the model, or a time, whose last edit counts.
std::optional<protocol::At> as_of(const Request& request);  // the query parameter
// As a sequence; nothing: now. Refused (422, `at`): what is neither, and a sequence that is not there yet.
Result<std::optional<std::int64_t>> find_sequence(const RouteContext& context, const room::Room& room,
                                                  const std::optional<protocol::At>& at);

}  // namespace strata::net
