#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "app/services.h"
#include "domain/people/role.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "query/statistics/quantities.h"

namespace strata::app {

// The measures of all records of a table that have lines or points.
struct FeatureMeasures {
  std::vector<std::string> names;  // as in RecordMeasures; empty: no column has lines or points
  std::map<std::int64_t, std::vector<double>> of_key;  // one value per name

  // Reads the state after sequence `at` of the table, or the current state. With `model`, measures
  // only the lines and points on this model. Blocks.
  static Result<FeatureMeasures> of_table(const Services& services, const Table& table,
                                          Role seen_by, const std::optional<Model>& model,
                                          std::optional<std::int64_t> at);

  std::vector<double> sum() const;
  std::vector<double> of(std::int64_t key) const;  // zeros for a record without lines or points
};

// Adds the records that have lines or points but no painted texels to the quantities of their
// layer. Sorts the classes by key.
void add_classes(query::Quantities& all, const FeatureMeasures& features);

}  // namespace strata::app
