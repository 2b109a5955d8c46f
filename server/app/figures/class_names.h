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

// What the values of layers are called in tables that people read.
namespace strata::app {

// by key; of those that are there, also without a name
using RecordNames = std::map<std::int64_t, std::string>;

// Names of records as `seen_by` reads them, after an edit of the table where `at` names one; terms
// by their labels in `language`.
Result<RecordNames> record_names(store::Store& store, TableId table_id, Role seen_by,
                                 std::vector<std::int64_t> keys, std::optional<std::int64_t> at,
                                 const std::string& language);

// What the layer's legend calls a value of its own; empty: it has no label for it.
std::string palette_label(const Layer& layer, double value);

// What a class is called: the record's name, the label of the legend, or nothing.
std::string quantity_label(const query::Quantity& quantity, const Layer& layer,
                           const RecordNames& names);
// As people read it in a column of its own: its label, or its value or range.
std::string quantity_text(const query::Quantity& quantity, const std::string& label);

// Names of values of a layer, in their order: the record's name, or the label of the legend, or
// else the number.
Result<std::vector<std::string>> class_names(store::Store& store, const Layer& layer, Role seen_by,
                                             const std::vector<double>& values,
                                             std::optional<std::int64_t> at,
                                             const std::string& language);

}  // namespace strata::app
