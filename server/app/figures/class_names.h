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

// Names of layer values, for tables that people read.
namespace strata::app {

// by key; contains all existing records, also those without a name
using RecordNames = std::map<std::int64_t, std::string>;

// Returns the names of records as the role `seen_by` sees them; with `at`, after that edit of the
// table. Terms have their labels in `language`.
Result<RecordNames> record_names(store::Store& store, TableId table_id, Role seen_by,
                                 std::vector<std::int64_t> keys, std::optional<std::int64_t> at,
                                 const std::string& language);

// Returns the label of a single value in the layer's legend; empty if it has none.
std::string palette_label(const Layer& layer, double value);

// Returns the name of a class: the record's name, the label of the legend, or an empty text.
std::string quantity_label(const query::Quantity& quantity, const Layer& layer,
                           const RecordNames& names);
// Returns the text of a class in a column: its label, or its value or range.
std::string quantity_text(const query::Quantity& quantity, const std::string& label);

// Returns the names of a layer's values, in their order: the record's name, the label of the
// legend, or the number.
Result<std::vector<std::string>> class_names(store::Store& store, const Layer& layer, Role seen_by,
                                             const std::vector<double>& values,
                                             std::optional<std::int64_t> at,
                                             const std::string& language);

}  // namespace strata::app
