#include "app/figures/record_marks.h"

#include <algorithm>
#include <cmath>

#include "room/edits.h"
#include "room/queries.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

// The distance is multiplied by at least this factor, so steep surfaces hide points behind them.
constexpr double kMinCosine = 1.0 / 12;
// The depth below the surface at which lines and points are still drawn in the image.
constexpr double kPlaceReach_px = 4, kPlaceReachOfSize = 1e-3;

}  // namespace

Result<std::optional<std::int64_t>> table_sequence(store::Store& store,
                                                   const FigureRequest& request,
                                                   const Layer& layer) {
  if (*request.shown.at >= request.room->edits().durable_sequence()) return std::nullopt;
  const auto then = STRATA_TRY(
      store.tables().sequence_when(*layer.table, request.room->model().id, *request.shown.at));
  return then;
}

Result<std::vector<KeyFeature>> features_in(store::Store& store, const FigureRequest& request,
                                            const Layer& layer) {
  const auto at = STRATA_TRY(table_sequence(store, request, layer));
  return store.records().features(*layer.table, request.role, request.room->model().id, at);
}

MarkSight::MarkSight(const FigureRequest& request, const Camera& camera)
    : request_(request), camera_(camera) {
  const Model model = request.room->model();
  const double pixel = 2 / (std::abs(camera.projection[0][0]) * camera.width);
  reach_ = kPlaceReach_px * pixel +
           kPlaceReachOfSize * glm::distance(model.bounds_min, model.bounds_max);
}

glm::dvec2 MarkSight::pixel_of(const glm::dvec3& place) const {
  const glm::dvec4 clip = camera_.projection * camera_.view * glm::dvec4(place, 1);
  return {(clip.x + 1) / 2 * camera_.width, (1 - clip.y) / 2 * camera_.height};
}

Result<bool> MarkSight::sees(const glm::dvec3& place) const {
  const auto is_cut_off = [&](const glm::dvec4& plane) {
    return glm::dot(plane, glm::dvec4(place, 1)) < 0;
  };
  if (std::ranges::any_of(camera_.section, is_cut_off)) return false;
  const glm::dvec2 pixel = pixel_of(place);
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x <= camera_.width && pixel.y <= camera_.height))
    return false;
  const auto hit = request_.room->queries().pick(camera_, pixel.x, pixel.y, {}, {});
  if (!hit) return tl::unexpected(hit.error());
  if (!hit->hit) return true;
  const glm::dvec3 apart = place - glm::dvec3(hit->position);
  if ((camera_.view * glm::dvec4(apart, 0)).z >= 0) return true;  // in front of the surface
  return std::max(std::abs(glm::dot(apart, glm::dvec3(hit->normal))),
                  kMinCosine * glm::length(apart)) <= reach_;
}

}  // namespace strata::app
