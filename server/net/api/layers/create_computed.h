#pragma once

#include "net/api/layers/layer_jobs.h"
#include "room/room.h"

namespace strata::net {

// POST …/layers with `compute`: the job that computes the layer from the model's shape. `layer`:
// what the request says of it, which precedes what follows from the recipe.
Result<Response> create_shape_layer(const RouteContext& context, JobIdempotency& book,
                                    const Request& request, const std::shared_ptr<room::Room>& room,
                                    const protocol::LayerCreate& body, Layer layer);

// POST …/layers with `expression`: makes the layer and computes it; nothing is left of one that
// cannot be computed. 201, or 202 with a job where the expression reads the shape of the surface.
Result<Response> create_formula_layer(const RouteContext& context, JobIdempotency& book,
                                      const Request& request,
                                      const std::shared_ptr<room::Room>& room, Layer layer,
                                      bool has_palette,
                                      const std::function<Response(const Layer&)>& answer);

}  // namespace strata::net
