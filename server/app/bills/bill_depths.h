#pragma once

#include <optional>
#include <string>

#include "app/bills/bill_elements.h"
#include "bill/exact_number.h"
#include "core/error.h"
#include "domain/tables/table.h"

namespace strata {
struct Layer;
}  // namespace strata

namespace strata::app {

// Returns the error of a rule that names an entity that does not exist or that the role does not
// see. `what` describes the entity: "table 3".
tl::unexpected<Error> no_such_source(const std::string& what, const std::string& field);

// Returns `found`, or for `not_found` the error of the rule.
template <class T>
Result<T> of_rule(Result<T> found, const std::string& what, const std::string& field) {
  if (!found && found.error().code == ErrorCode::not_found) return no_such_source(what, field);
  return found;
}

// The depths of the elements of a rule that measures volumes. Errors name a field of the rule.
class BillDepths {
 public:
  // `table` is null if the rule has none. For other rules, the result has no use. Returns an
  // `invalid` error for a column that does not exist, has no numbers, or has no unit of lengths.
  static Result<BillDepths> of(const protocol::BillRule& rule, const Table* table);

  // Returns area times depth in m³. `value` is the key or class on the layer, and `record` the
  // record of the key, if any. A record without a depth has no volume. Blocks if the depth is that
  // of a layer.
  Result<bill::ExactNumber> volume(const Services& services, const BillSource& source,
                                   const Layer& layer, double value, double area_m2,
                                   const Record* record);

 private:
  Result<bill::ExactNumber> measured_volume(const Services& services, const BillSource& source,
                                            const Layer& layer, double value);

  std::optional<bill::ExactNumber> metres_;
  std::optional<ColumnId> column_;
  std::optional<std::string> layer_;
  double unit_ = 1;  // of the column, in meters
  std::size_t classes_ = 0;
};

}  // namespace strata::app
