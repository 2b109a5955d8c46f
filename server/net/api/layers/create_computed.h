#pragma once

#include "jobs/shape_recipe.h"
#include "net/api/layers/layer_jobs.h"
#include "room/room.h"

namespace strata::net {

// Returns the recipe with its default values. Refuses (422 at a field of `compute`) a recipe that
// cannot be computed for the model.
Result<jobs::ShapeRecipe> checked_recipe(const RouteContext& context, const Request& request,
                                         const Model& model, const protocol::ShapeRecipe& body);

// POST …/layers with `compute`. Starts the job that computes the layer from the shape of the model.
// Properties in the request (`layer`) have precedence over properties of the recipe.
Result<Response> create_shape_layer(const RouteContext& context, JobIdempotency& book,
                                    const Request& request, const std::shared_ptr<room::Room>& room,
                                    const protocol::LayerCreate& body, Layer layer);

// POST …/layers with `expression`. Creates the layer and computes it. Removes the layer if the
// computation fails. Returns 201, or 202 with a job if the expression reads the shape of the
// surface.
Result<Response> create_formula_layer(const RouteContext& context, JobIdempotency& book,
                                      const Request& request,
                                      const std::shared_ptr<room::Room>& room, Layer layer,
                                      bool has_palette,
                                      const std::function<Response(const Layer&)>& answer);

}  // namespace strata::net
