#include "net/serialization/record_place.h"

#include "core/no_such.h"
#include "domain/people/role.h"
#include "domain/tables/table.h"
#include "net/api/addressed.h"
#include "store/content/layers.h"
#include "store/store.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {

Result<app::RecordPlace> record_place(const RouteContext& context, const Request& request) {
  if (!request.params.contains("layer")) {
    auto table = STRATA_TRY(stored_table(context, request));
    return app::RecordPlace{std::move(table), {}, {}};
  }
  auto model = STRATA_TRY(stored_model(context, request));
  auto layer =
      STRATA_TRY(context.store.layers().find(model.id, request.param("layer"), request.role()));
  if (!layer.table)
    return fail(ErrorCode::invalid, "Numeric layer",
                layer.name + " stores numbers, so it has no records.", "layer");
  auto table = context.store.tables().find(to_string(*layer.table), request.role());
  if (!table) return tl::unexpected(table.error());
  return app::RecordPlace{std::move(*table), std::move(model), std::move(layer)};
}

Result<std::int64_t> record_key(const Request& request) {
  auto key = parse_integer(request.param("key"), 0, kMaxRecordKey, "key");
  if (!key) return no_such("record", request.param("key"));
  return key;
}

Result<Record> stored_record(const RouteContext& context, const Table& table, Role seen_by,
                             std::int64_t key, std::optional<std::int64_t> at, Table* then) {
  store::RecordQuery query;
  query.keys = std::vector{key};
  query.at = at;
  auto page = STRATA_TRY(context.store.records().page(table.id, seen_by, query));
  if (page.records.empty()) return no_such("record", std::to_string(key));
  if (then) *then = page.table;
  return page.records.front();
}

Result<std::optional<std::int64_t>> expected_record_version(const RouteContext& context,
                                                            const Request& request,
                                                            const Table& table, std::int64_t key) {
  if (request.header("if-match").empty()) return std::optional<std::int64_t>();
  auto record = STRATA_TRY(stored_record(context, table, request.role(), key, {}));
  STRATA_TRY(check_if_match(request, record.version));
  return request.header("if-match") == "*" ? std::optional<std::int64_t>()
                                           : std::optional(record.version);
}

}  // namespace strata::net
