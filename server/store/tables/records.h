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
  std::optional<std::vector<std::int64_t>> keys;    // only these, by key, whatever the page
  std::optional<std::int64_t> at;                   // as after that sequence of the table
  std::int64_t limit = 100, offset = 0;
  std::optional<Expression> filter{};  // only those where this condition over columns holds
  // in whose alphabet texts are sorted ("de-at"); empty: in none in particular
  std::string language{};
  // Only records that follow this place in the order: what RecordPage::last was. Refused
  // (invalid, `after`): one of another order.
  std::optional<nlohmann::json> after{};
};

struct RecordPage {
  Table table;  // with the columns of then
  std::vector<Record> records;
  std::int64_t total = 0;
  // where the page ends, while records follow it: an array of texts, nulls and whole numbers
  std::optional<nlohmann::json> last{};
};

// Rows of tables. Part of Store: its rules for threads and errors hold.
class Records {
 public:
  explicit Records(Pool& pool) : pool_(pool) {}

  Result<RecordPage> page(TableId table_id, Role seen_by, const RecordQuery& query);
  // What a number or a condition over columns is for each record, where it is known; after sequence
  // `at` of the table, or now. Refused (invalid at `field`): what the columns do not fit.
  Result<std::vector<KeyNumber>> numbers(TableId table_id, Role seen_by,
                                         const Expression& expression,
                                         std::optional<std::int64_t> at, const std::string& field);
  // What a column holds for each record that has a value there, now: as text, canonical (of a term,
  // its key). Refused (invalid at `field`): a column that is not there or holds lists.
  Result<std::vector<KeyText>> texts(TableId table_id, Role seen_by, const std::string& column,
                                     const std::string& field);
  // The lines and points that records of a table have on a model, by key; after sequence `at` of
  // the table, or now.
  Result<std::vector<KeyFeature>> features(TableId table_id, Role seen_by, ModelId model_id,
                                           std::optional<std::int64_t> at = {});
  // All or none: where the change has problems, nothing was written.
  Result<TableChange> write(TableId table_id, const WriteRecords& asked, const std::string& user,
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
