#include "net/computed_layers.h"

#include "jobs/shape_layer.h"

namespace strata::net {
namespace {

jobs::ShapeRecipe recipe_of(const protocol::ShapeRecipe& asked) {
  jobs::ShapeRecipe recipe;
  recipe.kind = *jobs::parse_shape_kind(name(asked.kind));  // the schema has the same names
  recipe.radius_mm = asked.radius_mm;
  recipe.distance_mm = asked.distance_mm;
  recipe.rays = asked.rays;
  recipe.absolute = asked.absolute;
  recipe.model = asked.model.value_or("");
  recipe.property = asked.property.value_or("");
  recipe.source = asked.source.value_or("");
  return recipe;
}

// Before the job is started, so that a slip of the pen is told at once.
Result<void> check_other_model(store::Store& store, const jobs::ShapeRecipe& recipe) {
  if (recipe.model.empty()) return {};
  auto other = store.model(recipe.model);
  if (other) return {};
  Error problem = other.error();
  if (problem.code == ErrorCode::not_found)
    problem = {ErrorCode::invalid, "No such model", "There is no model \"" + recipe.model + "\".",
               "compute.model"};
  return tl::unexpected(std::move(problem));
}

}  // namespace

Result<Response> start_computing(const RouteContext& context, JobBook& book, const Request& request,
                                 const std::shared_ptr<room::Room>& room,
                                 const protocol::LayerCreate& asked, Layer wish) {
  auto recipe = jobs::completed(recipe_of(*asked.compute), room->model());
  if (!recipe) return tl::unexpected(recipe.error());
  STRATA_TRY(check_other_model(context.store, *recipe));
  auto make = [&store = context.store, room, wish = std::move(wish), recipe = std::move(*recipe),
               has_palette = asked.palette.has_value(), user = request.user()](
                  NewLayers& layers, Progress& progress) -> Result<nlohmann::json> {
    const Model model = room->model();
    auto computed = jobs::compute_shape_layer(store, model, room->geometry(), recipe, wish.type,
                                              wish.resolution, progress);
    if (!computed) return tl::unexpected(computed.error());
    Layer layer = wish;
    layer.origin = LayerOrigin::shape;
    if (layer.unit.empty()) layer.unit = computed->unit;
    layer.description += (layer.description.empty() ? "" : "\n\n") + computed->description;
    if (!has_palette) layer.palette = std::move(computed->palette);
    progress.report(1, "Saving");
    auto made =
        layers.add(std::move(layer), std::move(computed->tiles), std::move(computed->recipe));
    if (!made) return tl::unexpected(made.error());
    // Others see it once they want to.
    STRATA_TRY(store.show_layer_to(user, made->model_id, made->id));
    return nlohmann::json();
  };
  return start_layer_job(context, book, request, room, std::move(make));
}

}  // namespace strata::net
