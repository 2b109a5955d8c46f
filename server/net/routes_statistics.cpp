#include "net/as_of.h"
#include "net/routes.h"
#include "net/sheet.h"
#include "net/wire.h"
#include "query/expression_parser.h"

namespace strata::net {
namespace {

Result<room::Selection> selection_of(const RouteContext& context, const room::Room& room,
                                     const std::optional<std::string>& where,
                                     const std::optional<protocol::Within>& within,
                                     const std::optional<protocol::At>& at) {
  room::Selection selection;
  if (where) {
    auto condition = query::parse_condition(*where, "where");
    if (!condition) return tl::unexpected(condition.error());
    selection.where = std::move(*condition);
  }
  if (within && within->path) {
    selection.within = room::Outline{*within->camera, *within->path, within->through.value_or(false)};
  } else if (within) {
    room::Selection::Around around;
    around.at = place_of(*within->at);
    around.radius = in_model_units(*within->radius_mm, room.model().unit);
    selection.within = std::move(around);
  }
  auto sequence = find_sequence(context, room, at);
  if (!sequence) return tl::unexpected(sequence.error());
  selection.at = *sequence;
  return selection;
}

Result<Response> statistics(const RouteContext& context, const Request& request) {
  room::StatisticsWanted wanted;
  for (const auto& part : split_list(request.query_or("include", {}))) {
    if (part == "pieces")
      wanted.pieces = true;
    else if (part == "perimeter")
      wanted.perimeter = true;
    else if (part == "quantiles")
      wanted.quantiles = true;
    else
      return fail(422, "Unknown part", "`include` takes pieces, perimeter and quantiles, with commas between.",
                  "include");
  }
  auto room = context.rooms.open(request.param("model"), request.role());
  if (!room) return tl::unexpected(room.error());
  auto layer = (*room)->layer(request.param("layer"));
  if (!layer) return tl::unexpected(layer.error());
  std::optional<std::string> where;
  if (const auto given = request.query.find("where"); given != request.query.end()) where = given->second;
  const auto selection = selection_of(context, **room, where, std::nullopt, as_of(request));
  if (!selection) return tl::unexpected(selection.error());
  const auto sequence = selection->at.value_or((*room)->sequence());
  auto statistics = (*room)->statistics(layer->slug, *selection, wanted);
  if (!statistics) return tl::unexpected(statistics.error());
  Response response = json_response(to_json(*statistics));
  add_sequences(response, sequence, (*room)->durable_sequence());
  return response;
}

// The edit that paints where the condition holds.
Result<room::EditRequest> painting(const Request& request, const protocol::SelectRequest& asked,
                                   const room::Room& room) {
  if (request.principal->role < Role::annotator)
    return fail(403, "Not allowed", "`into` paints, which needs the role annotator.", "into");
  if (!asked.where || asked.within || asked.at)
    return fail(422, "Cannot be painted",
                "`into` paints where a condition holds now: give `where`, and neither `within` nor `at`.", "into");
  const auto layer = room.layer(protocol::to_ref(asked.into->layer));
  if (!layer) {
    Problem problem = layer.error();
    problem.field = "into.layer";
    return tl::unexpected(std::move(problem));
  }
  protocol::EditFill fill;
  fill.mode = protocol::EditFillMode::where;
  fill.where = asked.where;
  fill.value = asked.into->value;
  fill.erase = asked.into->erase;
  return edit_request(fill, *layer, room.model(), edit_id(request, *layer, "select"), request.author());
}

void select(const RouteContext& context, const Request& request, const Respond& respond) {
  const auto asked = body_of<protocol::SelectRequest>(request);
  if (!asked) return respond(asked.error());
  const auto room = context.rooms.open(request.param("model"), request.role());
  if (!room) return respond(room.error());
  std::vector<std::string> refs, slugs;
  for (const auto& ref : asked->layers.value_or(std::vector<protocol::LayerRef>{}))
    refs.push_back(protocol::to_ref(ref));
  const auto layers = find_layers(**room, refs, "layers");
  if (!layers) return respond(layers.error());
  for (const auto& layer : *layers) slugs.push_back(layer.slug);
  const auto selection = selection_of(context, **room, asked->where, asked->within, asked->at);
  if (!selection) return respond(selection.error());
  room::StatisticsWanted wanted;
  for (const auto part : asked->include.value_or(std::vector<protocol::StatisticsPart>{})) switch (part) {
      case protocol::StatisticsPart::pieces: wanted.pieces = true; break;
      case protocol::StatisticsPart::perimeter: wanted.perimeter = true; break;
      case protocol::StatisticsPart::quantiles: wanted.quantiles = true; break;
    }
  std::optional<room::EditRequest> edit;
  if (asked->into) {
    auto made = painting(request, *asked, **room);
    if (!made) return respond(made.error());
    edit = std::move(*made);
  }
  const auto sequence = selection->at.value_or((*room)->sequence());
  const auto area = (*room)->select(*selection, slugs, wanted);
  if (!area) return respond(area.error());
  nlohmann::json body = to_json(*area);
  if (edit)
    return apply_edit(context, request, *room, std::move(*edit), respond, [body](nlohmann::json of_edit) mutable {
      body["edit"] = std::move(of_edit);
      return std::move(body);
    });
  Response response = json_response(body);
  add_sequences(response, sequence, (*room)->durable_sequence());
  respond(std::move(response));
}

Result<Response> cross_table(const RouteContext& context, const Request& request) {
  const auto asked = body_of<protocol::CrossTableRequest>(request);
  if (!asked) return tl::unexpected(asked.error());
  const auto room = context.rooms.open(request.param("model"), request.role());
  if (!room) return tl::unexpected(room.error());
  const auto rows = find_layers(**room, {protocol::to_ref(asked->rows)}, "rows");
  if (!rows) return tl::unexpected(rows.error());
  const auto columns = find_layers(**room, {protocol::to_ref(asked->columns)}, "columns");
  if (!columns) return tl::unexpected(columns.error());
  const auto selection = selection_of(context, **room, asked->where, asked->within, asked->at);
  if (!selection) return tl::unexpected(selection.error());
  const auto sequence = selection->at.value_or((*room)->sequence());
  const auto table = (*room)->cross_table(rows->front().slug, columns->front().slug, *selection);
  if (!table) return tl::unexpected(table.error());
  const bool as_csv = request.header("accept").find("text/csv") != std::string_view::npos;
  Response response = as_csv
                          ? text_response(cross_table_csv(*table, rows->front().slug, columns->front().slug), kCsvType)
                          : json_response(to_json(*table));
  add_sequences(response, sequence, (*room)->durable_sequence());
  response.with("Vary", "Accept");
  return response;
}

}  // namespace

void add_statistics_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/layers/{layer}/statistics",
              .handler = answering([&context](const Request& request) { return statistics(context, request); }),
              .query = {"include", "at", "where"}});
  router.add(
      {.method = Method::post,
       .pattern = "/api/v1/models/{model}/select",
       .handler = [&context](const Request& request, const Respond& respond) { select(context, request, respond); },
       .body = BodyKind::memory,
       .max_body = context.options.max_json_bytes});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/cross-table",
              .handler = answering([&context](const Request& request) { return cross_table(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes});
}

}  // namespace strata::net
