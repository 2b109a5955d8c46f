#include "app/figures/record_marks.h"

#include <algorithm>
#include <cmath>

#include "query/sampling/feature_parts.h"
#include "render/view/drawn_features.h"
#include "room/edits.h"
#include "room/queries.h"
#include "room/surface.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

// The distance is multiplied by at least this factor, so steep surfaces hide points behind them.
constexpr double kMinCosine = 1.0 / 12;

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
  auto features = STRATA_TRY(
      store.records().features(*layer.table, request.role, request.room->model().id, at));
  room::Surface& surface = request.room->surface();
  if (request.hidden_parts.any() && !surface.geometry()->part_ends.empty()) {
    const auto tree = surface.search_tree();
    query::find_parts(features, *surface.geometry(), *tree);
    std::erase_if(features, [&](const KeyFeature& feature) {
      return request.hidden_parts.test(static_cast<std::size_t>(feature.part));
    });
  }
  return features;
}

MarkSight::MarkSight(const FigureRequest& request, const Camera& camera)
    : request_(request), camera_(camera) {
  const Model model = request.room->model();
  pixel_ = 2 / (std::abs(camera.projection[0][0]) * camera.width);
  model_size_ = glm::distance(model.bounds_min, model.bounds_max);
}

double MarkSight::reach_of(const std::vector<glm::dvec3>& places) const {
  return std::max(render::kFeatureReach_px * pixel_, render::reach_on_model(places, model_size_));
}

glm::dvec2 MarkSight::pixel_of(const glm::dvec3& place) const {
  const glm::dvec4 clip = camera_.projection * camera_.view * glm::dvec4(place, 1);
  return {(clip.x + 1) / 2 * camera_.width, (1 - clip.y) / 2 * camera_.height};
}

std::optional<std::pair<double, double>> MarkSight::part_in_drawing(const glm::dvec3& from,
                                                                    const glm::dvec3& to) const {
  double begin = 0, end = 1;
  // Keeps the part where a linear function with these values at the ends is not negative.
  const auto narrow = [&](double at_from, double at_to) {
    if (at_from < 0 && at_to < 0) end = -1;
    if (at_from < 0 && at_to >= 0) begin = std::max(begin, at_from / (at_from - at_to));
    if (at_from >= 0 && at_to < 0) end = std::min(end, at_from / (at_from - at_to));
  };
  for (const glm::dvec4& plane : camera_.section)
    narrow(glm::dot(plane, glm::dvec4(from, 1)), glm::dot(plane, glm::dvec4(to, 1)));
  const glm::dvec2 a = pixel_of(from), b = pixel_of(to), size(camera_.width, camera_.height);
  for (int axis = 0; axis < 2; ++axis) {
    narrow(a[axis], b[axis]);
    narrow(size[axis] - a[axis], size[axis] - b[axis]);
  }
  if (begin > end) return std::nullopt;
  return std::pair(begin, end);
}

Result<bool> MarkSight::sees(const glm::dvec3& place, double reach) const {
  const glm::dvec2 pixel =
      glm::clamp(pixel_of(place), glm::dvec2(0), glm::dvec2(camera_.width, camera_.height));
  const auto hit = request_.room->queries().pick(camera_, pixel.x, pixel.y, {}, {});
  if (!hit) return tl::unexpected(hit.error());
  if (!hit->hit) return true;
  const glm::dvec3 apart = place - glm::dvec3(hit->position);
  if ((camera_.view * glm::dvec4(apart, 0)).z >= 0) return true;  // in front of the surface
  return std::max(std::abs(glm::dot(apart, glm::dvec3(hit->normal))),
                  kMinCosine * glm::length(apart)) <= reach;
}

}  // namespace strata::app
