#pragma once

#include <string>

#include "core/ids.h"
#include "domain/tables/attachment.h"
#include "domain/tables/table.h"
#include "protocol/parse.h"
#include "store/store.h"
#include "store/tables/table_changes.h"

// Converts tables between the protocol and the domain.
namespace strata::net {

// Returns the project's table `ref` as curators see it. Returns 422 at `field` if the table does
// not exist.
Result<Table> table_of_project(store::Store& store, ProjectId project_id,
                               const protocol::TableRef& ref, const std::string& field);

Result<Column> new_column(store::Store& store, ProjectId project_id,
                          const protocol::ColumnCreate& body,
                          const std::string& target_field = "target");
Result<std::vector<Column>> new_columns(store::Store& store, ProjectId project_id,
                                        const std::vector<protocol::ColumnCreate>& requested);

// Reads the values in a request body. Their names are slugs or ids of columns. Returns 422 if the
// table has no such column.
Result<std::map<ColumnId, nlohmann::json>> values_by_column(const Table& table,
                                                            const nlohmann::json& values,
                                                            const std::string& field);

nlohmann::json to_json(const store::TableEditRow& row);
nlohmann::json to_json(const Attachment& attachment);

// Returns the sequence in the text, or the sequence of the table at the time in the text (RFC
// 3339).
Result<std::int64_t> sequence_at(store::Store& store, const Table& table, const std::string& text);

}  // namespace strata::net
