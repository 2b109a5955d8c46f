#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Call after the layer's visibility changed. Participants who no longer see the layer are notified
// that its threads are gone; those who see it now receive the threads.
void tell_threads(const RouteContext& context, const Layer& layer, Visibility before,
                  const std::string& user);

}  // namespace strata::net
