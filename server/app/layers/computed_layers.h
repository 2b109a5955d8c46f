#pragma once

#include <memory>

#include "app/layers/new_layers.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "jobs/shape_layer.h"
#include "store/store.h"

namespace strata::app {

// Completes the recipe for the model. Returns `invalid` with a field of `compute` if the model does
// not have a property of the recipe, or if the model for comparison does not exist in a project
// that `roles` can see. Runs before the job, so users see mistakes immediately.
Result<jobs::ShapeRecipe> check_recipe(store::Store& store, jobs::ShapeRecipe recipe,
                                       const Model& model, const Roles& roles);

// Computes the content of a layer from the shape of the model, at the resolution and with the type
// of `requested`. Blocks.
Result<jobs::ShapeLayer> shape_content(store::Store& store, room::Room& room,
                                       const jobs::ShapeRecipe& recipe, const Layer& requested,
                                       Progress& progress);

// Computes a layer from the shape of the model and paints it. Properties in `requested` have
// precedence over those of the recipe. At first, only `user` can see the layer. Blocks.
Result<Layer> add_shape_layer(store::Store& store, room::Room& room, NewLayers& layers,
                              const Layer& requested, const jobs::ShapeRecipe& recipe,
                              bool has_palette, const std::string& user, Progress& progress);

}  // namespace strata::app
