#pragma once

#include <chrono>

namespace strata::store {

// How long a caller waits. A database that hangs (its machine paused, its disk stuck) answers
// nothing and closes nothing, and a Unix socket has no time-out of its own.
struct PgLimits {
  // of silence, then the connection is given up: neither sent nor received
  std::chrono::milliseconds answer{30'000};
  std::chrono::milliseconds statement{300'000};  // statement_timeout; 0: none
  std::chrono::milliseconds lock{10'000};        // lock_timeout; 0: none

  bool operator==(const PgLimits&) const = default;
};
// For what a person waits for; for whole scans in one transaction; for changes of the schema, which
// wait for other servers.
inline constexpr PgLimits kRequestLimits{};
inline constexpr PgLimits kBulkLimits{std::chrono::minutes(10), std::chrono::minutes(0),
                                      std::chrono::minutes(5)};
inline constexpr PgLimits kMigrationLimits{std::chrono::hours(1), std::chrono::minutes(0),
                                           std::chrono::minutes(0)};

}  // namespace strata::store
