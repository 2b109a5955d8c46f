#include "app/records/record_measures.h"

#include <algorithm>

#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/tables/surface_feature.h"
#include "domain/tables/table.h"
#include "room/queries.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/content/models.h"
#include "store/store.h"

namespace strata::app {

Result<RecordMeasures> RecordMeasures::of_place(const Services& services, const RecordPlace& place,
                                                const std::vector<Column>& columns) {
  RecordMeasures measures;
  if (place.layer) {
    measures.has_area_ = true;
    measures.names_.emplace_back(kAreaMeasure);
    if (place.layer->sequence > 0) {  // otherwise it was never painted
      auto room = services.rooms.open(to_string(place.model->id), Role::owner);
      if (!room) return tl::unexpected(room.error());
      auto areas = STRATA_TRY((*room)->queries().key_areas(place.layer->slug));
      measures.areas_ = std::move(areas);
    }
  }
  for (const Column& column : columns) {
    if (column.kind == ColumnKind::line) measures.lines_.push_back(column);
    if (column.kind == ColumnKind::point) measures.points_.push_back(column);
  }
  if (!measures.lines_.empty()) measures.names_.emplace_back(kLengthMeasure);
  if (!measures.points_.empty()) measures.names_.emplace_back("point_count");
  if (measures.lines_.empty() && measures.points_.empty()) return measures;
  if (place.model) {
    measures.metres_[place.model->id] = place.model->metres();
    return measures;
  }
  const auto models = STRATA_TRY(services.store.models().all(place.table.project_id));
  for (const Model& model : models) measures.metres_[model.id] = model.metres();
  return measures;
}

double RecordMeasures::area_m2(std::int64_t key) const {
  const auto area = areas_.find(key);
  return area == areas_.end() ? 0 : area->second.area_m2;
}

std::vector<double> RecordMeasures::of(const Record& record) const {
  std::vector<double> values;
  if (has_area_) values.push_back(area_m2(record.key));
  const auto for_each_feature = [&](const std::vector<Column>& columns, auto visit) {
    for (const Column& column : columns)
      for (const SurfaceFeature& feature : features_of(record, column))
        if (const auto metres = metres_.find(feature.model); metres != metres_.end())
          visit(feature, metres->second);
  };
  if (!lines_.empty()) {
    double length_m = 0;
    for_each_feature(lines_, [&](const SurfaceFeature& feature, double metres) {
      length_m += length_of(feature) * metres;
    });
    values.push_back(length_m);
  }
  if (!points_.empty()) {
    double count = 0;
    for_each_feature(points_, [&](const SurfaceFeature&, double) { ++count; });
    values.push_back(count);
  }
  return values;
}

void add_measures(nlohmann::json& json, const std::vector<std::string>& names,
                  const std::vector<double>& values) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "point_count")
      json[names[i]] = static_cast<std::int64_t>(values[i]);
    else
      json[names[i]] = values[i];
  }
}

}  // namespace strata::app
