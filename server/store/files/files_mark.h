#pragma once

#include <optional>
#include <string>

#include "core/uuid.h"
#include "store/pg/sql.h"

namespace strata::store {

// The content of strata-files.json. A database owns the files if its row of `file_store` has the
// same id, and the text kDatabaseId/OWNER.
struct FilesMark {
  Uuid id;  // of the site
  std::string owner;
};
std::string to_text(const FilesMark& mark);
// Returns nothing for a text that is not a mark.
std::optional<FilesMark> parse_files_mark(const std::string& text);

// SQL: identifies this database among its restored copies, except copies of the whole cluster.
inline constexpr auto kDatabaseId =
    sql("((SELECT system_identifier::text FROM pg_control_system()) || '/' || "
        "(SELECT oid::text FROM pg_database WHERE datname = current_database()))");

}  // namespace strata::store
