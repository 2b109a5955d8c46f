#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/records/record_place.h"
#include "app/services.h"
#include "core/ids.h"
#include "query/statistics/key_areas.h"

namespace strata::app {

inline constexpr const char* kAreaMeasure = "area_m2";

// The measures of a record on the surface: under a layer, `area_m2` of its texels there; `length_m`
// of its lines and `point_count` of its points, if the table has such columns, under a layer those
// on its model, otherwise those on all models.
class RecordMeasures {
 public:
  // `columns`: those of the records that are passed to `of`; the place's layer must be visible to
  // the caller. May open a room, and blocks.
  static Result<RecordMeasures> of_place(const Services& services, const RecordPlace& place,
                                         const std::vector<Column>& columns);

  const std::vector<std::string>& names() const { return names_; }
  std::vector<double> of(const Record& record) const;  // one per name
  double area_m2(std::int64_t key) const;

 private:
  std::vector<std::string> names_;
  bool has_area_ = false;
  std::map<std::int64_t, query::KeyArea> areas_;
  std::vector<Column> lines_, points_;
  std::map<ModelId, double> metres_;  // meters per unit of the models whose features count
};

// Adds each value under its name; counts are integers.
void add_measures(nlohmann::json& json, const std::vector<std::string>& names,
                  const std::vector<double>& values);

}  // namespace strata::app
