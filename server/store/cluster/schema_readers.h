#pragma once

#include <chrono>
#include <string_view>

#include "store/pg/pg.h"

namespace strata::store {

// A migration that is readable for older programs (migrations.h) may add a form of data that they
// cannot read.
enum class OlderPrograms {
  running,   // the site has a node of another version
  excluded,  // they can no longer start, but one that has just started may still join the site
  absent,    // they were excluded at least `after_mark` ago
};
// Excludes programs without the migration from the database, unless one is running. `migration` is
// its version, and `version` that of this program. A node whose lease is over also counts as
// running, because a node that was paused joins again without another check of the database.
Result<OlderPrograms> exclude_older_programs(PgConnection& connection, std::string_view migration,
                                             std::string_view version,
                                             std::chrono::milliseconds after_mark);

}  // namespace strata::store
