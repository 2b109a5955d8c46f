#include "net/api/layers/create_computed.h"

#include "app/edits.h"
#include "app/layers/computed_layers.h"
#include "app/layers/formula_layers.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "net/http/idempotency_store.h"
#include "room/room.h"
#include "store/content/layers.h"
#include "store/store.h"

namespace strata::net {
namespace {

jobs::ShapeRecipe recipe_of(const protocol::ShapeRecipe& body) {
  jobs::ShapeRecipe recipe;
  recipe.kind = *jobs::parse_shape_kind(name(body.kind));  // the schema uses the same names
  recipe.radius_mm = body.radius_mm;
  recipe.distance_mm = body.distance_mm;
  recipe.normal_scale_mm = body.normal_scale_mm;
  recipe.projection_scale_mm = body.projection_scale_mm;
  recipe.registration_mm = body.registration_mm;
  recipe.latitude_deg = body.latitude_deg;
  recipe.north_deg = body.north_deg;
  recipe.from = body.from.value_or("");
  recipe.to = body.to.value_or("");
  recipe.wind_shares = body.wind_shares.value_or(std::vector<double>());
  recipe.wind_speed_m_s = body.wind_speed_m_s;
  recipe.rain_mm = body.rain_mm;
  recipe.rain_mm_per_hour = body.rain_mm_per_hour;
  recipe.rays = body.rays;
  recipe.absolute = body.absolute;
  recipe.model = body.model.value_or("");
  recipe.property = body.property.value_or("");
  recipe.source = body.source.value_or("");
  recipe.look = body.look.value_or("");
  return recipe;
}

}  // namespace

Result<jobs::ShapeRecipe> checked_recipe(const RouteContext& context, const Request& request,
                                         const Model& model, const protocol::ShapeRecipe& body) {
  return app::check_recipe(context.store, recipe_of(body), model, request.principal->roles);
}

Result<Response> create_shape_layer(const RouteContext& context, JobIdempotency& book,
                                    const Request& request, const std::shared_ptr<room::Room>& room,
                                    const protocol::LayerCreate& body, Layer layer) {
  auto recipe = STRATA_TRY(checked_recipe(context, request, room->model(), *body.compute));
  return start_layer_job(
      context, book, request, room,
      [&store = context.store, room, layer = std::move(layer), recipe = std::move(recipe),
       has_palette = body.palette.has_value(), user = request.user()](
          app::NewLayers& layers, Progress& progress) -> Result<nlohmann::json> {
        STRATA_TRY(
            app::add_shape_layer(store, *room, layers, layer, recipe, has_palette, user, progress));
        return nlohmann::json();
      });
}

Result<Response> create_formula_layer(const RouteContext& context, JobIdempotency& book,
                                      const Request& request,
                                      const std::shared_ptr<room::Room>& room, Layer layer,
                                      bool has_palette,
                                      const std::function<Response(const Layer&)>& answer) {
  const auto expression = STRATA_TRY(app::parse_formula(layer.formula->expression));
  const Author author = request.author();
  if (app::reads_shape(*room, expression))
    return start_layer_job(
        context, book, request, room,
        [&context, room, layer = std::move(layer), author, has_palette](
            app::NewLayers& layers, Progress& progress) -> Result<nlohmann::json> {
          STRATA_TRY(
              app::add_formula_layer(context, room, layers, layer, author, has_palette, progress));
          return nlohmann::json();
        });
  app::NewLayers layers(room, context.edits, author);
  Progress progress;
  Result<void> shown;
  if (auto made = app::add_formula_layer(context, room, layers, std::move(layer), author,
                                         has_palette, progress);
      !made)
    shown = tl::unexpected(made.error());
  else
    shown = layers.show(idempotent_response<Layer>(request, answer));
  if (!shown) {
    layers.take_back();
    return tl::unexpected(shown.error());
  }
  return answer(STRATA_TRY(
      context.store.layers().find(room->model().id, to_string(layers.ids().front()), Role::owner)));
}

}  // namespace strata::net
