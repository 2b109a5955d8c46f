#pragma once

#include "core/error.h"
#include "domain/scene/model.h"
#include "expression/expression.h"

namespace strata::app {

// Checks the radius, width and range of the functions along the surface in a formula of a layer of
// this resolution (query/regions/neighborhood_limits), so that users need not wait for a job that
// must fail. Returns the error of the job at `expression`, with the position of the function.
// Models that do not know the size of their texels (reported_texel_size) have only the checks of
// the job. So have limits that depend on the content of layers.
Result<void> check_formula_limits(const Expression& expression, const Model& model, int resolution);

}  // namespace strata::app
