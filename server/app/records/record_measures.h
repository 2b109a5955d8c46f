#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/records/record_place.h"
#include "app/services.h"
#include "core/ids.h"
#include "query/statistics/key_areas.h"

namespace strata::app {

inline constexpr const char *kAreaMeasure = "area_m2", *kLengthMeasure = "length_m";

// The measures of a record on the surface. For a layer, `area_m2` is the area of the record's
// texels. If the table has columns with lines or points, `length_m` is the length of the lines and
// `point_count` the number of points. For a layer, they include only the lines and points on its
// model. Otherwise, they include the lines and points on all models.
class RecordMeasures {
 public:
  // `columns` must be the columns of the records that are passed to `of`. The layer in `place` must
  // be visible to the caller. May open a room. Blocks.
  static Result<RecordMeasures> of_place(const Services& services, const RecordPlace& place,
                                         const std::vector<Column>& columns);

  const std::vector<std::string>& names() const { return names_; }
  std::vector<double> of(const Record& record) const;  // one value per name
  double area_m2(std::int64_t key) const;

 private:
  std::vector<std::string> names_;
  bool has_area_ = false;
  std::map<std::int64_t, query::KeyArea> areas_;
  std::vector<Column> lines_, points_;
  std::map<ModelId, double> metres_;  // meters per unit of the measured models
};

// Adds each value under its name. Counts are integers.
void add_measures(nlohmann::json& json, const std::vector<std::string>& names,
                  const std::vector<double>& values);

}  // namespace strata::app
