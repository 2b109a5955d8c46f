#pragma once

#include <cstdint>
#include <optional>

#include "app/records/record_place.h"
#include "net/api/route_help.h"

// Functions for all routes of records.
namespace strata::net {

// Returns the table in the address, or the table of the layer in the address.
Result<app::RecordPlace> record_place(const RouteContext& context, const Request& request);

// Returns the key in the address. Returns 404 if it is not a key.
Result<std::int64_t> record_key(const Request& request);

// Returns the record with the columns that the role can see. Returns 404 if it does not exist.
// `then` receives the table with its columns at the sequence `at`.
Result<Record> stored_record(const RouteContext& context, const Table& table, Role seen_by,
                             std::int64_t key, std::optional<std::int64_t> at,
                             Table* then = nullptr);

// Returns the version in If-Match. Returns 412 if it is out of date, and nothing if any version is
// allowed.
Result<std::optional<std::int64_t>> expected_record_version(const RouteContext& context,
                                                            const Request& request,
                                                            const Table& table, std::int64_t key);

}  // namespace strata::net
