#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "query/statistics/quantities.h"
#include "store/store.h"

// Names of layer values, for tables that users read.
namespace strata::app {

// Names by key. Contains all existing records, including those without names.
using RecordNames = std::map<std::int64_t, std::string>;

// Returns the names of records as visible to the role `seen_by`. With `at`, these are the names
// after that edit of the table. Terms have labels in `language`.
Result<RecordNames> record_names(store::Store& store, TableId table_id, Role seen_by,
                                 std::vector<std::int64_t> keys, std::optional<std::int64_t> at,
                                 const std::string& language);

// Returns the label of a single value in the layer's legend. Returns an empty text if it has no
// label.
std::string palette_label(const Layer& layer, double value);

// Returns the name of a class. This is the name of the record, the label in the legend, or an empty
// text.
std::string quantity_label(const query::Quantity& quantity, const Layer& layer,
                           const RecordNames& names);
// Returns the text that describes a class. This is the label or, without a label, the value or
// range.
std::string quantity_text(const query::Quantity& quantity, const std::string& label);

// Returns the names of values of a layer, in the order of `values`. A name is the name of the
// record, the label in the legend, or the number.
Result<std::vector<std::string>> class_names(store::Store& store, const Layer& layer, Role seen_by,
                                             const std::vector<double>& values,
                                             std::optional<std::int64_t> at,
                                             const std::string& language);

}  // namespace strata::app
