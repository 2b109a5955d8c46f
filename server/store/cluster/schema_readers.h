#pragma once

#include <string_view>

#include "store/pg/pg.h"

namespace strata::store {

// A migration that is readable for older programs (migrations.h) may add a form of data that they
// cannot read.
enum class OlderPrograms {
  running,   // a node of another version has a lease
  excluded,  // from now on: programs without the migration can no longer start
  absent,    // they were excluded before
};
// Excludes programs without the migration from the database, unless one is running. `migration` is
// its version, and `version` that of this program.
Result<OlderPrograms> exclude_older_programs(PgConnection& connection, std::string_view migration,
                                             std::string_view version);

}  // namespace strata::store
