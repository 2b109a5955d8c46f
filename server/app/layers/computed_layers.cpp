#include "app/layers/computed_layers.h"
#include "query/sampling/lightness_tiles.h"
#include "room/room.h"
#include "room/surface.h"
#include "store/content/models.h"
#include "store/content/surface_images.h"
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

Result<SurfaceImage> image_of(store::Store& store, const jobs::ShapeRecipe& recipe,
                              const Model& model) {
  auto image = store.surface_images().find(model.id, recipe.look);
  if (image || image.error().code != ErrorCode::not_found) return image;
  return fail(ErrorCode::invalid, "Surface image not found",
              "The model has no surface image \"" + recipe.look + "\".", "compute.look");
}

Result<jobs::ShapeLayer> lightness_layer(store::Store& store, room::Room& room,
                                         const jobs::ShapeRecipe& recipe, const Layer& requested,
                                         Progress& progress) {
  progress.report(0, "Reading the colors");
  const Model model = room.model();
  std::optional<SurfaceImageId> image;
  std::string name;
  if (!recipe.look.empty()) {
    const auto found = STRATA_TRY(image_of(store, recipe, model));
    image = found.id;
    name = found.name;
  }
  const auto map = STRATA_TRY(room.surface().map(requested.resolution));
  const auto colors = room.surface().colors(requested.resolution, image);
  if (!colors) {
    Error problem = colors.error();
    if (problem.code == ErrorCode::invalid)
      problem.field = problem.field.empty() ? "compute.kind" : "compute." + problem.field;
    return tl::unexpected(std::move(problem));
  }
  if (progress.cancelled()) return cancelled_problem();
  auto tiles = STRATA_TRY(query::lightness_tiles(**colors, *map, requested.type, progress));
  return jobs::described(std::move(tiles), recipe, model, requested.type, name);
}

}  // namespace

Result<jobs::ShapeRecipe> check_recipe(store::Store& store, jobs::ShapeRecipe recipe,
                                       const Model& model, const Roles& roles) {
  const auto other = STRATA_TRY(other_model(store, recipe, roles));
  auto complete = STRATA_TRY(jobs::completed(std::move(recipe), model, other ? &*other : nullptr));
  if (!complete.look.empty()) {
    const auto image = STRATA_TRY(image_of(store, complete, model));
    complete.look = to_string(image.id);
  }
  return complete;
}

Result<jobs::ShapeLayer> shape_content(store::Store& store, room::Room& room,
                                       const jobs::ShapeRecipe& recipe, const Layer& requested,
                                       Progress& progress) {
  if (recipe.kind == jobs::ShapeKind::lightness)
    return lightness_layer(store, room, recipe, requested, progress);
  return jobs::compute_shape_layer(store, room.model(), room.surface().geometry(), recipe,
                                   requested.type, requested.resolution, progress);
}

Result<Layer> add_shape_layer(store::Store& store, room::Room& room, NewLayers& layers,
                              const Layer& requested, const jobs::ShapeRecipe& recipe,
                              bool has_palette, const std::string& user, Progress& progress) {
  auto computed = STRATA_TRY(shape_content(store, room, recipe, requested, progress));
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
