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

// What a record has on the surface, beside what its columns hold: `area_m2` under a layer, the
// surface that it has there; `length_m` of its lines and `point_count` of its points where the
// table has such columns, under a layer those on its model, otherwise on all that are there.
class RecordMeasures {
 public:
  // `columns`: those of the records that will be asked for; a layer of the place is one that who
  // asks sees. May open a room, and blocks.
  static Result<RecordMeasures> of_place(const Services& services, const RecordPlace& place,
                                         const std::vector<Column>& columns);

  const std::vector<std::string>& names() const { return names_; }
  std::vector<double> of(const Record& record) const;  // one for each name
  double area_m2(std::int64_t key) const;

 private:
  std::vector<std::string> names_;
  bool has_area_ = false;
  std::map<std::int64_t, query::KeyArea> areas_;
  std::vector<Column> lines_, points_;
  std::map<ModelId, double> metres_;  // of the unit of each model whose marks count
};

// Each under its name: numbers, counts as whole ones.
void add_measures(nlohmann::json& json, const std::vector<std::string>& names,
                  const std::vector<double>& values);

}  // namespace strata::app
