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
  std::vector<std::pair<std::string, bool>> order;  // column (or `key`), and true if descending
  std::optional<std::vector<std::int64_t>> keys;    // only these records, by key, without paging
  std::optional<std::int64_t> at;                   // the state after that sequence of the table
  std::int64_t limit = 100, offset = 0;
  std::optional<Expression> filter{};  // only records for which this condition over columns is true
  // language of the sort order of texts ("de-at"); empty for no particular language
  std::string language{};
  // Only records that follow this position in the order, which is the RecordPage::last of an
  // earlier page. A position in another order is an `invalid` error at `after`.
  std::optional<nlohmann::json> after{};
};

struct RecordPage {
  Table table;  // the table, with its columns at that time
  std::vector<Record> records;
  std::int64_t total = 0;
  // position at which the page ends, if more records follow: an array of texts, nulls and whole
  // numbers
  std::optional<nlohmann::json> last{};
};

// Rows of tables. Part of Store, whose rules for threads and errors apply.
class Records {
 public:
  explicit Records(Pool& pool) : pool_(pool) {}

  Result<RecordPage> page(TableId table_id, Role seen_by, const RecordQuery& query);
  // Returns the value of a number or condition over columns for each record where the value is
  // known. Reads the state after sequence `at` of the table, or the current state. Returns an
  // `invalid` error at `field` for an expression that is not valid for the columns.
  Result<std::vector<KeyNumber>> numbers(TableId table_id, Role seen_by,
                                         const Expression& expression,
                                         std::optional<std::int64_t> at, const std::string& field);
  // Returns the current value of a column for each record that has a value, as canonical text. The
  // text of a term is its key. Returns an `invalid` error at `field` for a column that does not
  // exist or has lists as values.
  Result<std::vector<KeyText>> texts(TableId table_id, Role seen_by, const std::string& column,
                                     const std::string& field);
  // Returns the lines and points that records of a table have on a model, by key. Reads the state
  // after sequence `at` of the table, or the current state.
  Result<std::vector<KeyFeature>> features(TableId table_id, Role seen_by, ModelId model_id,
                                           std::optional<std::int64_t> at = {});
  // Writes all records or none. If the change has problems, nothing was written.
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
