#pragma once

#include <string>

#include "core/ids.h"
#include "domain/tables/attachment.h"
#include "domain/tables/table.h"
#include "protocol/parse.h"
#include "store/store.h"
#include "store/tables/table_changes.h"

// Between the protocol's tables and the domain's.
namespace strata::net {

// The project's table that `ref` names, as curators see it; 422 with `field` where it has none.
Result<Table> table_of_project(store::Store& store, ProjectId project_id,
                               const protocol::TableRef& ref, const std::string& field);

Result<Column> new_column(store::Store& store, ProjectId project_id,
                          const protocol::ColumnCreate& body,
                          const std::string& target_field = "target");
Result<std::vector<Column>> new_columns(store::Store& store, ProjectId project_id,
                                        const std::vector<protocol::ColumnCreate>& asked);

// Values by slug or id of a column, as a body has them; 422 where the table has no such column.
Result<std::map<ColumnId, nlohmann::json>> values_by_column(const Table& table,
                                                            const nlohmann::json& values,
                                                            const std::string& field);

nlohmann::json to_json(const store::TableEditRow& row);
nlohmann::json to_json(const Attachment& attachment);

// A sequence of the table, or the one that was there at a time (RFC 3339).
Result<std::int64_t> sequence_at(store::Store& store, const Table& table, const std::string& text);

}  // namespace strata::net
