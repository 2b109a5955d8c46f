// The preview of a computed layer before it is created.
#include <utility>

#include "app/layers/formula_layers.h"
#include "app/layers/layer_preview.h"
#include "core/progress.h"
#include "core/text/base64.h"
#include "domain/layers/layer.h"
#include "domain/people/question.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "media/picture.h"
#include "net/api/addressed.h"
#include "net/api/layers/create_computed.h"
#include "net/api/layers/new_layer.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/at_field.h"
#include "net/serialization/statistics_serialization.h"
#include "net/transport/server_options.h"
#include "room/layers.h"
#include "room/room.h"

namespace strata::net {
namespace {

tl::unexpected<Error> in_layer(const Error& problem) {
  return at_field(problem, problem.field.empty() ? "layer" : "layer." + problem.field);
}

// Cancels work that asks only its Progress when the question ends.
class QuestionProgress final : public Progress {
 public:
  bool cancelled() const override {
    return Progress::cancelled() || (question_ != nullptr && question_->is_over());
  }

 private:
  const Question* const question_ = Question::current();
};

Result<Response> preview_layer(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::LayerPreviewRequest>(request));
  const protocol::LayerCreate& wanted = body.layer;
  if (!wanted.compute && !wanted.expression)
    return fail(ErrorCode::invalid, "Layer without computation",
                "Only computed layers have a preview. Send `expression` or `compute`.", "layer");
  const auto room = STRATA_TRY(open_room(context, request));
  auto layer = new_layer(wanted, room->model(), room->layers().all());
  if (!layer) return in_layer(layer.error());
  std::optional<jobs::ShapeRecipe> recipe;
  if (wanted.compute) {
    auto checked = checked_recipe(context, request, room->model(), *wanted.compute);
    if (!checked) return in_layer(checked.error());
    recipe = std::move(*checked);
  } else {
    auto formula = app::read_formula(*room, *wanted.expression, false, *layer);
    if (!formula) return in_layer(formula.error());
    layer->formula = std::move(*formula);
  }
  const room::SeenGrid grid{body.picture.camera, body.picture.width, body.picture.height};
  QuestionProgress progress;
  const auto made =
      app::preview_layer(context, *room, std::move(*layer), recipe, wanted.palette.has_value(),
                         request.author(), grid, progress);
  if (!made) {
    if (Question* question = Question::current()) question->check();  // throws the reason
    return in_layer(made.error());
  }
  return json_response({{"resolution", made->layer.resolution},
                        {"share", made->share},
                        {"unit", made->layer.unit},
                        {"palette", to_json(made->layer.palette)},
                        {"statistics", to_json(made->statistics)},
                        {"picture", to_base64(encode_png(made->rgba, grid.columns, grid.rows))}});
}

}  // namespace

void add_layer_preview_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/layer-preview",
              .handler = answering(
                  [&context](const Request& request) { return preview_layer(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
