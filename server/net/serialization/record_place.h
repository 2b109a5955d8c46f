#pragma once

#include <cstdint>
#include <optional>

#include "app/records/record_place.h"
#include "net/api/route_help.h"

// What the addresses of records have in common.
namespace strata::net {

// The table of the address: its own, or that of a layer.
Result<app::RecordPlace> record_place(const RouteContext& context, const Request& request);

// Of the address; 404 for what is none.
Result<std::int64_t> record_key(const Request& request);

// With what the role sees of it; 404 where it is not there. `then` gets the table with the columns
// of `at`.
Result<Record> stored_record(const RouteContext& context, const Table& table, Role seen_by,
                             std::int64_t key, std::optional<std::int64_t> at,
                             Table* then = nullptr);

// By If-Match (412 where it is stale); nothing: any will do.
Result<std::optional<std::int64_t>> wished_record_version(const RouteContext& context,
                                                          const Request& request,
                                                          const Table& table, std::int64_t key);

}  // namespace strata::net
