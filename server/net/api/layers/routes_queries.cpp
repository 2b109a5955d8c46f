#include <cmath>

#include "domain/scene/model.h"
#include "domain/scene/units.h"
#include "mesh/analysis/section_area.h"
#include "net/api/addressed.h"
#include "net/api/models/rollout_fit.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/serialization/as_of.h"
#include "net/serialization/at_field.h"
#include "net/serialization/point_serialization.h"
#include "net/serialization/point_text.h"
#include "net/serialization/sheet_response.h"
#include "net/transport/server_options.h"
#include "query/sampling/profile.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/surface.h"

namespace strata::net {
namespace {

constexpr double kShortestNormal = 1e-12;  // of a plane's normal

std::vector<std::string> slugs_of(const std::vector<Layer>& layers) {
  std::vector<std::string> slugs;
  for (const auto& layer : layers) slugs.push_back(layer.slug);
  return slugs;
}

// Returns the layers in the request body, or all layers if the body names none.
Result<std::vector<Layer>> requested_layers(
    const room::Room& room, const std::optional<std::vector<protocol::LayerRef>>& requested) {
  if (!requested) return room.layers().all();
  std::vector<std::string> refs;
  for (const auto& ref : *requested) refs.push_back(protocol::to_ref(ref));
  return find_layers(room, refs, "layers");
}

Result<Response> position(const RouteContext& context, const Request& request) {
  auto coordinates = STRATA_TRY(parse_point(request.query_or("coords", {})));
  const std::string format = request.query_or("f", "json");
  if (format != "json" && format != "covjson" && format != "csv")
    return fail(ErrorCode::not_acceptable, "Unknown format", "`f` must be json, covjson or csv.",
                "f");
  auto room = STRATA_TRY(open_room(context, request));
  std::vector<Layer> layers = room->layers().all();
  if (auto named = request.query.find("parameter-name"); named != request.query.end()) {
    auto found = find_layers(*room, split_list(named->second), "parameter-name");
    if (!found) return tl::unexpected(found.error());
    layers = std::move(*found);
  }
  const auto requested_at = as_of(request);
  const auto at = STRATA_TRY(find_sequence(context, *room, requested_at));
  const auto sequence = at.value_or(room->edits().sequence());
  auto point = room->queries().position(coordinates, slugs_of(layers), at);
  if (!point) return tl::unexpected(point.error());
  Response response;
  if (format == "csv")
    response = text_response(points_csv({*point}, slugs_of(layers)), kCsvType);
  else if (format == "json")
    response = json_response(protocol::to_json(to_protocol(*point)));
  else if (!point->hit)
    return fail(ErrorCode::not_found, "No surface",
                "The model has no surface, so there is no nearest point to `coords`.", "coords");
  else {
    response = json_response(point_coverage(*point, layers, room->model()));
    response.headers = {{"Content-Type", "application/prs.coverage+json"}};
  }
  add_sequences(response, sequence, room->edits().durable_sequence());
  return response;
}

Result<Response> positions(const RouteContext& context, const Request& request) {
  auto body =
      STRATA_TRY(body_of<protocol::PositionsRequest>(request, context.options.max_positions_bytes));
  auto room = STRATA_TRY(open_room(context, request));
  const auto layers = STRATA_TRY(requested_layers(*room, body.layers));
  const std::vector<glm::dvec3> points(body.points.begin(), body.points.end());
  const auto at = STRATA_TRY(find_sequence(context, *room, body.at));
  const auto sequence = at.value_or(room->edits().sequence());
  auto answers = room->queries().positions(points, slugs_of(layers), at);
  if (!answers) return tl::unexpected(answers.error());
  Response response;
  if (request.header("accept").find("text/csv") != std::string_view::npos) {
    response = text_response(points_csv(*answers, slugs_of(layers)), kCsvType);
  } else {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& point : *answers) list.push_back(protocol::to_json(to_protocol(point)));
    const std::size_t total = list.size();
    response = json_response({{"positions", std::move(list)}, {"total", total}});
  }
  add_sequences(response, sequence, room->edits().durable_sequence());
  response.with("Vary", "Accept");
  return response;
}

Result<room::UnrolledLine> unrolled_line(const protocol::UnrolledLine& body, double step_mm,
                                         Unit unit) {
  const auto sheet = read_sheet(body);
  if (!sheet) return at_field(sheet.error(), "unrolled." + sheet.error().field);
  room::UnrolledLine line;
  line.fit = sheet->fit;
  line.cut = sheet->cut;
  for (const glm::dvec2& point : body.path) line.path.push_back(in_model_units(1, unit) * point);
  line.step = in_model_units(step_mm, unit);
  return line;
}

Result<Response> profile(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ProfileRequest>(request));
  const auto room = open_room(context, request);
  if (!room) return tl::unexpected(room.error());
  const auto layers = STRATA_TRY(requested_layers(**room, body.layers));
  const Unit unit = (*room)->model().unit;
  room::ProfileLine line;
  if (body.places)
    line = room::PlacesInSteps{*body.places, in_model_units(*body.step_mm, unit)};
  else if (body.unrolled)
    line = STRATA_TRY(unrolled_line(*body.unrolled, *body.step_mm, unit));
  else
    line = room::SeenLine{*body.camera, *body.path};
  const auto at = STRATA_TRY(find_sequence(context, **room, body.at));
  const auto sequence = at.value_or((*room)->edits().sequence());
  const auto found = (*room)->queries().profile(line, slugs_of(layers), at);
  if (!found) return tl::unexpected(found.error());
  const bool as_csv = request.header("accept").find("text/csv") != std::string_view::npos;
  Response response = as_csv ? text_response(profile_csv(*found, unit, slugs_of(layers)), kCsvType)
                             : json_response(to_json(*found, unit));
  add_sequences(response, sequence, (*room)->edits().durable_sequence());
  response.with("Vary", "Accept");
  return response;
}

Result<Response> section(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::SectionRequest>(request));
  for (std::size_t i = 0; i < body.section.size(); ++i)
    if (!(glm::length(glm::dvec3(body.section[i])) > kShortestNormal))
      return fail(ErrorCode::invalid, "Plane without a direction",
                  "The first three numbers of a plane must not all be 0.",
                  "section[" + std::to_string(i) + "]");
  auto room = STRATA_TRY(open_room(context, request));
  const double square = std::pow(room->model().metres(), 2);
  protocol::SectionMeasures measures;
  for (const auto& [area] : mesh::cut_areas(*room->surface().geometry(), body.section)) {
    measures.cuts.emplace_back();
    if (area) measures.cuts.back().area_m2 = *area * square;
  }
  return json_response(protocol::to_json(measures));
}

Result<Response> pick(const RouteContext& context, const Request& request) {
  auto body = STRATA_TRY(body_of<protocol::PickRequest>(request));
  auto room = STRATA_TRY(open_room(context, request));
  const auto at = STRATA_TRY(find_sequence(context, *room, body.at));
  const auto sequence = at.value_or(room->edits().sequence());
  auto point =
      room->queries().pick(body.camera, body.x, body.y, slugs_of(room->layers().all()), at);
  if (!point) return tl::unexpected(point.error());
  Response response = json_response(protocol::to_json(to_protocol(*point)));
  add_sequences(response, sequence, room->edits().durable_sequence());
  return response;
}

}  // namespace

void add_query_routes(Router& router, const RouteContext& context) {
  router.add({.method = Method::get,
              .pattern = "/api/v1/models/{model}/position",
              .handler = answering(
                  [&context](const Request& request) { return position(context, request); }),
              .query = {"coords", "parameter-name", "f", "at"}});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/positions",
              .handler = answering(
                  [&context](const Request& request) { return positions(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_positions_bytes,
              .is_question = true});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/profile",
              .handler = answering(
                  [&context](const Request& request) { return profile(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/section",
              .handler = answering(
                  [&context](const Request& request) { return section(context, request); }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
  router.add(
      {.method = Method::post,
       .pattern = "/api/v1/models/{model}/pick",
       .handler = answering([&context](const Request& request) { return pick(context, request); }),
       .body = BodyKind::memory,
       .max_body = context.options.max_json_bytes});
}

}  // namespace strata::net
