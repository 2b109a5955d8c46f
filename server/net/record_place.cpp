#include "net/record_place.h"

namespace strata::net {

Result<RecordPlace> record_place(const RouteContext& context, const Request& request) {
  if (!request.params.contains("layer")) {
    auto table = context.store.table(request.param("table"), request.role());
    if (!table) return tl::unexpected(table.error());
    return RecordPlace{std::move(*table), {}, {}};
  }
  auto model = context.store.model(request.param("model"));
  if (!model) return tl::unexpected(model.error());
  auto layer = context.store.layer(model->id, request.param("layer"), request.role());
  if (!layer) return tl::unexpected(layer.error());
  if (!layer->table)
    return fail(422, "Numeric layer",
                layer->name + " holds numbers; only database layers have records.", "layer");
  auto table = context.store.table(std::to_string(*layer->table), request.role());
  if (!table) return tl::unexpected(table.error());
  return RecordPlace{std::move(*table), std::move(*model), std::move(*layer)};
}

Result<std::int64_t> record_key(const Request& request) {
  auto key = parse_integer(request.param("key"), 0, kHighestKey, "key");
  if (!key)
    return fail(404, "Not found", "Keys of records are whole numbers from 0 to 4294967295.");
  return key;
}

Result<Record> stored_record(const RouteContext& context, const Table& table, Role seen_by,
                             std::int64_t key, std::optional<std::int64_t> at, Table* then) {
  store::Store::RecordQuery query;
  query.keys = std::vector{key};
  query.at = at;
  auto page = context.store.records(table.id, seen_by, query);
  if (!page) return tl::unexpected(page.error());
  if (page->records.empty())
    return fail(404, "Not found", table.name + " has no record " + std::to_string(key) + ".");
  if (then) *then = page->table;
  return page->records.front();
}

Result<std::optional<std::int64_t>> wished_record_version(const RouteContext& context,
                                                          const Request& request,
                                                          const Table& table, std::int64_t key) {
  if (request.header("if-match").empty()) return std::optional<std::int64_t>();
  auto record = stored_record(context, table, request.role(), key, {});
  if (!record) return tl::unexpected(record.error());
  if (auto fresh = check_if_match(request, record->version); !fresh)
    return tl::unexpected(fresh.error());
  return request.header("if-match") == "*" ? std::optional<std::int64_t>()
                                           : std::optional(record->version);
}

}  // namespace strata::net
