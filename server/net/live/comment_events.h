#pragma once

#include "net/api/route_help.h"

namespace strata::net {

// Another part of those who look sees the layer now: who ends to see the threads about it hears
// that they are gone, who begins hears of them.
void tell_threads(const RouteContext& context, const Layer& layer, Visibility before,
                  const std::string& user);

}  // namespace strata::net
