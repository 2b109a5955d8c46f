#include <algorithm>

#include "app/authorization/visibility_leak_check.h"
#include "app/layers/formula_layers.h"
#include "app/trash_purger.h"
#include "core/text/ascii.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "domain/tables/term_list.h"
#include "jobs/job_queue.h"
#include "net/api/addressed.h"
#include "net/api/layers/create_computed.h"
#include "net/api/layers/new_layer.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/comment_events.h"
#include "net/serialization/table_serialization.h"
#include "net/transport/server_options.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/content/layers.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<Response> list_layers(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto model = STRATA_TRY(stored_model(context, request));
  auto layers = STRATA_TRY(context.store.layers().of_model(model.id, request.role()));
  nlohmann::json list = nlohmann::json::array();
  const int total = static_cast<int>(layers.size());
  const auto part = STRATA_TRY(slice_by(page, layers, [](const Layer& layer) {
    return NumberKey{layer.order, layer.id.number()};
  }));
  for (std::size_t i = part.begin; i < part.end; ++i) list.push_back(to_json(layers[i]));
  Response response = json_response({{"layers", list}, {"total", total}});
  add_page_links(response, request, page, part.last);
  return response;
}

Result<Response> create_layer(const RouteContext& context, JobIdempotency& book,
                              const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::LayerCreate>(request));
  auto room = STRATA_TRY(open_room(context, request));
  const Model model = room->model();
  auto layer = STRATA_TRY(new_layer(body, model, room->layers().all()));
  if (body.table) {
    auto table = table_of_project(context.store, model.project_id, *body.table, "table");
    if (!table) return tl::unexpected(table.error());
    layer.table = table->id;
    // Colors the layer by terms.
    if (!body.palette && term_columns(*table)) layer.palette = terms_palette({});
  }
  Column name;
  name.name = "Name";
  Result<std::vector<Column>> columns = std::vector{name};
  if (body.columns) columns = new_columns(context.store, model.project_id, *body.columns);
  if (!columns) return tl::unexpected(columns.error());
  if (body.compute) return create_shape_layer(context, book, request, room, body, std::move(layer));
  if (body.expression) {
    auto formula = app::read_formula(*room, *body.expression, is_automatic(body.recompute), layer);
    if (!formula) return tl::unexpected(formula.error());
    layer.formula = std::move(*formula);
    layer.origin = LayerOrigin::expression;
  }
  STRATA_TRY(app::check_shows_nothing(context.store, layer, {}));
  const auto answer = [model_slug = model.slug](const Layer& made) {
    return json_response(to_json(made), 201)
        .with("Location", "/api/v1/models/" + model_slug + "/layers/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  if (layer.formula)
    return create_formula_layer(context, book, request, room, std::move(layer),
                                body.palette.has_value(), answer);
  auto created = room->layers().create(
      std::move(layer), idempotent_response<Layer>(request, answer), std::move(*columns));
  if (!created) return tl::unexpected(created.error());
  return answer(*created);
}

// Sets or removes the expression of a numeric layer. With an empty expression, the layer becomes an
// ordinary layer and keeps its values. `before` is the former visibility. Users who could not see
// the layer before must not see hidden layers through it.
Result<void> set_formula(const room::Room& room, const protocol::LayerPatch& body,
                         Visibility before, Layer& layer) {
  const bool is_seen_by_more = layer.formula && layer.visibility < before;
  if (!body.expression && !body.recompute && !is_seen_by_more) return {};
  if (layer.kind != LayerKind::numeric)
    return fail(ErrorCode::invalid, "Invalid kind of layer", "A computed layer must be numeric.",
                "expression");
  if (body.expression && body.expression->empty()) {
    if (!layer.formula) return {};
    layer.formula.reset();
    layer.analysis.reset();
    layer.locked = body.locked.value_or(false);
    layer.edited_by_hand = true;
    return {};
  }
  if (!body.expression && !layer.formula)
    return fail(ErrorCode::invalid, "No expression",
                "Only layers with an `expression` can have `recompute`.", "recompute");
  const bool automatic =
      body.recompute ? is_automatic(body.recompute) : layer.formula && layer.formula->automatic;
  auto formula = app::read_formula(
      room, body.expression ? *body.expression : layer.formula->expression, automatic, layer);
  if (!formula) return tl::unexpected(formula.error());
  // A different expression will overwrite the painted values.
  const bool is_other = !layer.formula || layer.formula->expression != formula->expression;
  layer.formula = std::move(*formula);
  if (is_other) {
    layer.origin = LayerOrigin::expression;
    layer.analysis.reset();
    layer.locked = true;
    layer.edited_by_hand = false;
  }
  return {};
}

Result<Response> compute(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  auto layer =
      context.store.layers().find(room->model().id, request.param("layer"), request.role());
  if (!layer) return tl::unexpected(layer.error());
  const std::string overwrite = request.query_or("overwrite", "false");
  if (overwrite != "true" && overwrite != "false")
    return fail(ErrorCode::invalid, "Invalid value", "`overwrite` must be true or false.",
                "overwrite");
  if (overwrite == "true" && layer->edited_by_hand && request.role() < Role::curator)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only curators can recompute a layer that people edited by hand.", "overwrite");
  Progress progress;
  auto computed =
      app::compute_layer(context, room, *layer, request.author(), progress, overwrite == "true");
  if (!computed) return tl::unexpected(computed.error());
  return json_response(to_json(*computed)).with("ETag", etag_of(computed->version));
}

Result<Response> change_layer(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::LayerPatch>(request));
  auto room = STRATA_TRY(open_room(context, request));
  // Reads the stored layer because the room's copy may be slightly out of date.
  auto layer =
      context.store.layers().find(room->model().id, request.param("layer"), request.role());
  if (!layer) return tl::unexpected(layer.error());
  STRATA_TRY(check_if_match(request, layer->version));
  const auto answer = [](const Layer& now) {
    return json_response(to_json(now)).with("ETag", etag_of(now.version));
  };
  if (body.type) {
    protocol::LayerPatch alone;
    alone.type = body.type;
    if (!(body == alone))
      return fail(ErrorCode::invalid, "Type together with other changes",
                  "Change the type of a layer in a separate request.", "type");
    auto widened =
        room->layers().widen(*layer, *body.type, idempotent_response<Layer>(request, answer));
    return widened ? Result<Response>(answer(*widened)) : tl::unexpected(widened.error());
  }
  if (body.name) layer->name = *body.name;
  if (body.unit) layer->unit = *body.unit;
  if (body.description) layer->description = *body.description;
  if (body.labels) layer->labels = *body.labels;
  if (body.descriptions) layer->descriptions = *body.descriptions;
  if (body.group) layer->group = group_of(*body.group);
  if (body.palette) {
    auto palette = STRATA_TRY(palette_from_json(*body.palette));
    layer->palette = std::move(palette);
    layer->palette_of_terms = false;
  }
  if (body.opacity) layer->opacity = *body.opacity;
  if (body.blend) layer->blend = *body.blend;
  if (body.visible) layer->visible = *body.visible;
  if (body.locked == false && is_as_computed(*layer)) layer->edited_by_hand = true;
  if (body.locked) layer->locked = *body.locked;
  if (body.review) layer->review = *body.review;
  const Visibility before = layer->visibility;
  if (body.visibility) layer->visibility = *body.visibility;
  if (body.order) layer->order = *body.order;
  const bool was_painted = !layer->formula;
  STRATA_TRY(set_formula(*room, body, before, *layer));
  if (was_painted && layer->formula) {
    const auto queue = context.store.journal().review_queue(layer->id, {}, 0, 0);
    if (!queue) return tl::unexpected(queue.error());
    if (queue->total > 0)
      return fail(ErrorCode::conflict, "Edits waiting for review",
                  "Edits of this layer wait for review. Accept or reject them before the server "
                  "computes the layer.",
                  "expression");
  }
  STRATA_TRY(app::check_shows_nothing(context.store, *layer, room->layers().all()));
  auto changed =
      room->layers().update(std::move(*layer), idempotent_response<Layer>(request, answer));
  if (!changed) return tl::unexpected(changed.error());
  tell_threads(context, *changed, before, request.user());
  return answer(*changed);
}

Result<Response> delete_layer(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  STRATA_TRY(check_if_match(request, layer.version));
  auto gone = room->layers().put_in_trash(
      layer.id, idempotent_response<>(request, [] { return empty_response(204); }));
  if (!gone) return tl::unexpected(gone.error());
  if (context.options.trash_days == 0) context.trash_purger.check_now();
  return empty_response(204);
}

}  // namespace

void add_layer_routes(Router& router, const RouteContext& context) {
  auto book = std::make_shared<JobIdempotency>(context.jobs);
  const std::string layers = "/api/v1/models/{model}/layers";
  router.add({.method = Method::get,
              .pattern = layers,
              .handler = answering(
                  [&context](const Request& request) { return list_layers(context, request); }),
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = layers,
              .handler = answering([&context, book](const Request& request) {
                return create_layer(context, *book, request);
              }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .replay = [&context, book](const Request& request,
                                         const nlohmann::json& stored) -> Result<Response> {
                return stored.contains("layers") ? repeat_layer_job(context, *book, request, stored)
                                                 : response_of(stored);
              }});
  router.add({.method = Method::get,
              .pattern = layers + "/{layer}",
              .handler = answering([&context](const Request& request) -> Result<Response> {
                auto layer = STRATA_TRY(stored_layer(context, request));
                return with_etag(json_response(to_json(layer)), request, layer.version);
              })});
  router.add({.method = Method::patch,
              .pattern = layers + "/{layer}",
              .handler = answering(
                  [&context](const Request& request) { return change_layer(context, request); }),
              .role = Role::curator,
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::remove,
              .pattern = layers + "/{layer}",
              .handler = answering(
                  [&context](const Request& request) { return delete_layer(context, request); }),
              .role = Role::curator,
              .keeps_answer = true,
              .needs_version = true});
  router.add({.method = Method::post,
              .pattern = layers + "/{layer}/compute",
              .handler = answering(
                  [&context](const Request& request) { return compute(context, request); }),
              .role = Role::annotator,
              .query = {"overwrite"},
              .is_long_edit = true});
}

}  // namespace strata::net
