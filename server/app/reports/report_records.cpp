#include "app/reports/report_parts.h"
#include "domain/scene/model.h"
#include "domain/tables/surface_feature.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/store.h"
#include "store/tables/records.h"

namespace strata::app {

std::int64_t records_at(const ReportContext& context, const Layer& layer) {
  return context.request.records_at.at(*layer.table);
}

Result<std::map<std::int64_t, query::KeyArea>> record_places(const ReportContext& context,
                                                             const Layer& layer) {
  const ReportRequest& request = context.request;
  auto places = STRATA_TRY(request.room->queries().key_areas(layer.slug, request.shown.at));
  const auto at = records_at(context, layer);
  const auto features = STRATA_TRY(context.services.store.records().features(
      *layer.table, request.reader.role, request.room->model().id, at));
  for (const auto& [key, feature, part] : features) {
    if (feature.places.empty()) continue;
    const auto [found, is_new] = places.try_emplace(key);
    query::KeyArea& place = found->second;
    if (is_new) place.bounds_min = place.bounds_max = feature.places.front();
    for (const glm::dvec3& position : feature.places) {
      place.bounds_min = glm::min(place.bounds_min, position);
      place.bounds_max = glm::max(place.bounds_max, position);
    }
  }
  return places;
}

std::string record_label(const ReportWords& words, const std::map<std::int64_t, std::string>& names,
                         std::int64_t key) {
  const auto name = names.find(key);
  return name == names.end() || name->second.empty() ? filled(words.record, std::to_string(key))
                                                     : name->second;
}

}  // namespace strata::app
