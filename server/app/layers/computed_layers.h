#pragma once

#include <memory>

#include "app/layers/new_layers.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "jobs/shape_layer.h"
#include "store/store.h"

namespace strata::app {

// Completes the recipe for the model. Refuses (invalid, at members of `compute`) properties that
// the model does not have, and a missing model to compare with. Runs before the job, so that users
// learn of mistakes at once.
Result<jobs::ShapeRecipe> check_recipe(store::Store& store, jobs::ShapeRecipe recipe,
                                       const Model& model);

// Computes a layer from the shape of the model and paints it. `requested` has precedence over the
// recipe's properties. At first only `user` sees the layer. Blocks.
Result<Layer> add_shape_layer(store::Store& store, const room::Room& room, NewLayers& layers,
                              const Layer& requested, const jobs::ShapeRecipe& recipe,
                              bool has_palette, const std::string& user, Progress& progress);

}  // namespace strata::app
