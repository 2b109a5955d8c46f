#pragma once

namespace strata::net {

class Router;
struct RouteContext;

void add_demo_routes(Router& router, const RouteContext& context);

}  // namespace strata::net
