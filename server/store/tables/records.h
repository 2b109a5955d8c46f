#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "domain/layers/key_colors.h"
#include "domain/layers/key_numbers.h"
#include "domain/people/role.h"
#include "domain/tables/surface_feature.h"
#include "domain/tables/table.h"
#include "expression/expression.h"
#include "store/content/idempotent_response.h"
#include "store/tables/table_changes.h"

namespace strata::store {

class Pool;

struct RecordQuery {
  std::vector<std::pair<std::string, bool>> order;  // column (or `key`), descending
  std::optional<std::vector<std::int64_t>> keys;    // only these, by key, regardless of the page
  std::optional<std::int64_t> at;                   // as after that sequence of the table
  std::int64_t limit = 100, offset = 0;
  std::optional<Expression> filter{};  // only records for which this condition over columns is true
  // language of the sort order of texts ("de-at"); empty: no particular language
  std::string language{};
  // Only records that follow this place in the order: a former RecordPage::last. Refused (invalid,
  // `after`): a place of another order.
  std::optional<nlohmann::json> after{};
};

struct RecordPage {
  Table table;  // with the columns of that time
  std::vector<Record> records;
  std::int64_t total = 0;
  // place where the page ends, if more records follow: an array of texts, nulls and whole numbers
  std::optional<nlohmann::json> last{};
};

// Rows of tables. Part of Store: its rules for threads and errors hold.
class Records {
 public:
  explicit Records(Pool& pool) : pool_(pool) {}

  Result<RecordPage> page(TableId table_id, Role seen_by, const RecordQuery& query);
  // Returns the value of a number or condition over columns for each record where it is known;
  // after sequence `at` of the table, or now. Refused (invalid at `field`): an expression that does
  // not fit the columns.
  Result<std::vector<KeyNumber>> numbers(TableId table_id, Role seen_by,
                                         const Expression& expression,
                                         std::optional<std::int64_t> at, const std::string& field);
  // Returns the present value of a column for each record that has one: as canonical text (of a
  // term, its key). Refused (invalid at `field`): a column that does not exist or holds lists.
  Result<std::vector<KeyText>> texts(TableId table_id, Role seen_by, const std::string& column,
                                     const std::string& field);
  // Returns the lines and points that records of a table have on a model, by key; after sequence
  // `at` of the table, or now.
  Result<std::vector<KeyFeature>> features(TableId table_id, Role seen_by, ModelId model_id,
                                           std::optional<std::int64_t> at = {});
  // All or none: if the change has problems, nothing was written.
  Result<TableChange> write(TableId table_id, const WriteRecords& request, const std::string& user,
                            const IdempotentResponse<TableChange>& answer = {});
  Result<TableChange> remove(TableId table_id, std::int64_t key,
                             std::optional<std::int64_t> version, const std::string& user,
                             bool dry_run = false,
                             const IdempotentResponse<TableChange>& answer = {});
  Result<std::vector<std::int64_t>> missing(TableId table_id, std::span<const std::int64_t> keys);

 private:
  Pool& pool_;
};

}  // namespace strata::store
