#pragma once

#include "net/api/layers/layer_jobs.h"
#include "room/room.h"

namespace strata::net {

// POST …/layers with `compute`: starts the job that computes the layer from the model's shape. The
// properties that the request sets in `layer` have precedence over those of the recipe.
Result<Response> create_shape_layer(const RouteContext& context, JobIdempotency& book,
                                    const Request& request, const std::shared_ptr<room::Room>& room,
                                    const protocol::LayerCreate& body, Layer layer);

// POST …/layers with `expression`: makes the layer and computes it, or removes the layer if it
// cannot be computed. Returns 201, or 202 with a job if the expression reads the surface's shape.
Result<Response> create_formula_layer(const RouteContext& context, JobIdempotency& book,
                                      const Request& request,
                                      const std::shared_ptr<room::Room>& room, Layer layer,
                                      bool has_palette,
                                      const std::function<Response(const Layer&)>& answer);

}  // namespace strata::net
