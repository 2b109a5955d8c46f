// Rollouts: the unrolled surface of vessels, columns and vaults.
#include <algorithm>
#include <glm/trigonometric.hpp>

#include "app/figures/rollout.h"
#include "core/byte_budget.h"
#include "domain/scene/model.h"
#include "net/api/addressed.h"
#include "net/api/models/rollout_fit.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/accept.h"
#include "net/serialization/as_of.h"
#include "net/serialization/view_settings_serialization.h"
#include "net/transport/server_options.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"

namespace strata::net {
namespace {

// The memory for simultaneous pictures.
constexpr std::uint64_t kRolloutBytes = 320u << 20;
constexpr double kMaxPixels = 64e6;
constexpr int kMaxSide = 1'000'000;      // in pixels; libpng refuses larger pictures
constexpr double kDefaultPixels = 2000;  // on the longer side
constexpr double kMmPerMetre = 1000;

Result<app::RolloutRequest> read_rollout(const RouteContext& context, const Request& request,
                                         const protocol::RolloutRequest& body) {
  app::RolloutRequest rollout;
  const auto sheet = STRATA_TRY(read_sheet(body));
  rollout.fit = sheet.fit;
  rollout.cut = sheet.cut;
  auto room = STRATA_TRY(open_room(context, request));
  rollout.room = std::move(room);
  rollout.role = request.role();
  auto shown = STRATA_TRY(
      view_settings(*rollout.room, body.layers.value_or(std::vector<protocol::LayerOverride>{}),
                    body.looks, std::nullopt));
  rollout.shown = std::move(shown);
  for (Layer& layer : rollout.room->layers().all())
    if (rollout.shown.of(layer.id).visible.value_or(layer.visible))
      rollout.layers.push_back(std::move(layer));
  room::sort_as_shown(rollout.layers, rollout.shown);
  const auto at = STRATA_TRY(find_sequence(context, *rollout.room, body.at));
  rollout.at = at;
  rollout.relief = body.relief;
  return rollout;
}

std::string_view name_of(mesh::DevelopedShape shape) {
  switch (shape) {
    case mesh::DevelopedShape::cylinder: return "cylinder";
    case mesh::DevelopedShape::cone: return "cone";
    case mesh::DevelopedShape::general_cylinder: return "general_cylinder";
  }
  return {};
}

nlohmann::json numbers(const glm::dvec3& vector) { return {vector.x, vector.y, vector.z}; }

// Returns the `RolloutSheet` of the contract, without the cross section.
nlohmann::json sheet_json(const mesh::FittedSheet& plan, const mesh::RolloutWindow& window,
                          double metres_per_unit) {
  const mesh::RolloutSheet& sheet = plan.sheet;
  const mesh::DevelopedSurface& surface = sheet.surface;
  return {{"shape", name_of(surface.shape())},
          {"side", sheet.side == mesh::RolloutSide::outside ? "outside" : "inside"},
          {"axis", {{"point", numbers(surface.point)}, {"direction", numbers(surface.axis)}}},
          {"zero", numbers(surface.zero)},
          {"radius", surface.radius},
          {"half_angle", glm::degrees(surface.half_angle)},
          {"from", glm::degrees(sheet.from)},
          {"to", glm::degrees(sheet.to)},
          {"left", window.top_left.x},
          {"top", window.top_left.y},
          {"units_per_pixel", window.units_per_pixel},
          {"mm_per_pixel", window.units_per_pixel * metres_per_unit * kMmPerMetre},
          {"width", window.width},
          {"height", window.height},
          {"deviation", plan.fit.deviation}};
}

Result<mesh::RolloutWindow> window_on(const mesh::RolloutSheet& sheet,
                                      const std::optional<double>& mm_per_pixel,
                                      double metres_per_unit) {
  const glm::dvec2 size = sheet.max - sheet.min;
  const double units_per_pixel = mm_per_pixel ? *mm_per_pixel / kMmPerMetre / metres_per_unit
                                              : std::max(size.x, size.y) / kDefaultPixels;
  if (mesh::pixels_of(sheet, units_per_pixel) <= kMaxPixels) {
    const mesh::RolloutWindow window = mesh::window_of(sheet, units_per_pixel);
    if (std::max(window.width, window.height) <= kMaxSide) return window;
  }
  return fail(ErrorCode::too_large, "Picture too large",
              "The picture would have more than 64 million pixels, or more than 1 million on one "
              "side. Choose more millimeters per pixel.",
              "mm_per_pixel");
}

Result<Response> answer_rollout(const RouteContext& context, ByteBudget& budget,
                                const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::RolloutRequest>(request));
  const auto rollout = STRATA_TRY(read_rollout(context, request, body));
  const auto sequence = rollout.room->edits().sequence();
  const auto plan = STRATA_TRY(app::plan_rollout(rollout));
  const double metres_per_unit = rollout.room->model().metres();
  const auto window = STRATA_TRY(window_on(plan.sheet, body.mm_per_pixel, metres_per_unit));
  nlohmann::json sheet = sheet_json(plan, window, metres_per_unit);
  const std::string_view accept = request.header("accept");
  const bool only_sheet =
      accepts_type(accept, "application/json") && !accepts_type(accept, "image/png");
  Response response;
  if (only_sheet) {
    // The section is too long for a header.
    if (const auto& section = plan.sheet.surface.section) sheet["section"] = section->radii();
    response = json_response(sheet);
  } else {
    // The picture and its file exist at the same time.
    const auto held =
        STRATA_TRY(budget.take(std::uint64_t{8} * static_cast<std::uint64_t>(window.width) *
                               static_cast<std::uint64_t>(window.height)));
    Progress unwatched;  // an interrupted request ends the question
    const auto picture = STRATA_TRY(app::draw_rollout(context, rollout, plan, window, unwatched));
    response = bytes_response(encode_png(picture.rgba, picture.width, picture.height),
                              std::string(media_type(PictureFormat::png)));
    response.with("Strata-Rollout", sheet.dump());
  }
  response.with("Vary", "Accept");
  add_sequences(response, rollout.at.value_or(sequence), rollout.room->edits().durable_sequence());
  return response;
}

}  // namespace

void add_rollout_routes(Router& router, const RouteContext& context) {
  const auto budget = std::make_shared<ByteBudget>(kRolloutBytes);
  router.add({.method = Method::post,
              .pattern = "/api/v1/models/{model}/rollout",
              .handler = answering([&context, budget](const Request& request) {
                return answer_rollout(context, *budget, request);
              }),
              .body = BodyKind::memory,
              .max_body = context.options.max_json_bytes,
              .is_question = true});
}

}  // namespace strata::net
