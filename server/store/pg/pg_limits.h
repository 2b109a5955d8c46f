#pragma once

#include <chrono>

namespace strata::store {

// Limits for waiting. A database that hangs, because its machine is paused or its disk does not
// respond, neither answers nor closes the connection. A Unix socket has no timeout.
struct PgLimits {
  // the connection is closed after this time without a byte sent or received
  std::chrono::milliseconds answer{30'000};
  std::chrono::milliseconds statement{300'000};  // statement_timeout; 0 for no limit
  std::chrono::milliseconds lock{10'000};        // lock_timeout; 0 for no limit

  bool operator==(const PgLimits&) const = default;
};
// Limits for requests that a user waits for, for whole scans in one transaction, and for changes to
// the schema, which wait for other servers.
inline constexpr PgLimits kRequestLimits{};
inline constexpr PgLimits kBulkLimits{std::chrono::minutes(10), std::chrono::minutes(0),
                                      std::chrono::minutes(5)};
inline constexpr PgLimits kMigrationLimits{std::chrono::hours(1), std::chrono::minutes(0),
                                           std::chrono::minutes(0)};

}  // namespace strata::store
