#pragma once

#include "net/api/layers/layer_jobs.h"

namespace strata::net {

// POST …/layers with `compute`: the job that computes the layer from the model's shape. `layer`:
// what the caller says of it, which stands before what follows from the recipe.
Result<Response> start_computing(const RouteContext& context, JobBook& book, const Request& request,
                                 const std::shared_ptr<room::Room>& room,
                                 const protocol::LayerCreate& asked, Layer layer);

}  // namespace strata::net
