#pragma once

#include <chrono>

namespace strata::store {

// Limits for waiting. A database that hangs (its machine paused, its disk stuck) neither answers
// nor closes the connection, and a Unix socket has no time-out.
struct PgLimits {
  // close the connection after this time without a byte sent or received
  std::chrono::milliseconds answer{30'000};
  std::chrono::milliseconds statement{300'000};  // statement_timeout; 0: none
  std::chrono::milliseconds lock{10'000};        // lock_timeout; 0: none

  bool operator==(const PgLimits&) const = default;
};
// For requests that a user waits for; for whole scans in one transaction; for changes of the
// schema, which wait for other servers.
inline constexpr PgLimits kRequestLimits{};
inline constexpr PgLimits kBulkLimits{std::chrono::minutes(10), std::chrono::minutes(0),
                                      std::chrono::minutes(5)};
inline constexpr PgLimits kMigrationLimits{std::chrono::hours(1), std::chrono::minutes(0),
                                           std::chrono::minutes(0)};

}  // namespace strata::store
