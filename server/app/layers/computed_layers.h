#pragma once

#include <memory>

#include "app/layers/new_layers.h"
#include "core/progress.h"
#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "jobs/shape_layer.h"
#include "store/store.h"

namespace strata::app {

// The recipe, complete for the model. Refused (invalid, at members of `compute`): what the model
// does not have, and a model to compare with that does not exist. Before the job starts, so that
// users learn of mistakes at once.
Result<jobs::ShapeRecipe> check_recipe(store::Store& store, jobs::ShapeRecipe recipe,
                                       const Model& model);

// Computes a layer from the shape of the model and paints it. `wish` precedes what follows from
// the recipe. Only `user` sees it at first. Blocks.
Result<Layer> add_shape_layer(store::Store& store, const room::Room& room, NewLayers& layers,
                              const Layer& wish, const jobs::ShapeRecipe& recipe, bool has_palette,
                              const std::string& user, Progress& progress);

}  // namespace strata::app
