#include "app/layers/computed_layers.h"
#include "room/room.h"
#include "room/surface.h"
#include "store/content/models.h"
#include "store/people/personal_views.h"

namespace strata::app {
namespace {

// Returns nothing if the recipe needs no other model. A model of a project that the roles cannot
// see does not exist for the user.
Result<std::optional<Model>> other_model(store::Store& store, const jobs::ShapeRecipe& recipe,
                                         const Roles& roles) {
  if (recipe.model.empty()) return std::nullopt;
  auto other = store.models().find(recipe.model);
  if (other ? roles.in(other->project_id) < Role::viewer
            : other.error().code == ErrorCode::not_found)
    return fail(ErrorCode::invalid, "Model not found",
                "There is no model \"" + recipe.model + "\".", "compute.model");
  if (!other) return tl::unexpected(other.error());
  return std::move(*other);
}

}  // namespace

Result<jobs::ShapeRecipe> check_recipe(store::Store& store, jobs::ShapeRecipe recipe,
                                       const Model& model, const Roles& roles) {
  const auto other = STRATA_TRY(other_model(store, recipe, roles));
  return jobs::completed(std::move(recipe), model, other ? &*other : nullptr);
}

Result<Layer> add_shape_layer(store::Store& store, const room::Room& room, NewLayers& layers,
                              const Layer& requested, const jobs::ShapeRecipe& recipe,
                              bool has_palette, const std::string& user, Progress& progress) {
  auto computed =
      STRATA_TRY(jobs::compute_shape_layer(store, room.model(), room.surface().geometry(), recipe,
                                           requested.type, requested.resolution, progress));
  Layer layer = requested;
  layer.origin = LayerOrigin::shape;
  if (layer.unit.empty()) layer.unit = computed.unit;
  layer.description += (layer.description.empty() ? "" : "\n\n") + computed.description;
  if (!has_palette) layer.palette = std::move(computed.palette);
  progress.report(1, "Saving");
  auto made = STRATA_TRY(
      layers.add(std::move(layer), std::move(computed.tiles), std::move(computed.recipe)));
  // The layer is hidden by default. Shows it to its author.
  STRATA_TRY(store.personal_views().show_layer_to(user, made.model_id, made.id));
  return made;
}

}  // namespace strata::app
