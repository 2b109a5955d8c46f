// The trash of a project. A role that may delete an entity may also restore it.
#include <charconv>

#include "app/change_notifier.h"
#include "app/trash_purger.h"
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/serialization/people_serialization.h"
#include "net/transport/server_options.h"
#include "room/layers.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/store.h"
#include "store/tables/table_changes.h"

namespace strata::net {
namespace {

using store::TrashEntry;
using store::TrashRestored;

const char* name_of(TrashEntry::Kind kind) {
  return kind == TrashEntry::Kind::layer   ? "layer"
         : kind == TrashEntry::Kind::model ? "model"
                                           : "record";
}

store::Trash::Sight sight_of(const RouteContext& context, const Request& request) {
  return {request.role(), std::chrono::days(context.options.trash_days)};
}

nlohmann::json to_json(const TrashEntry& entry, std::chrono::days keep) {
  const std::string kind = name_of(entry.kind);
  const bool is_record = entry.kind == TrashEntry::Kind::record;
  const std::string table = is_record ? "-" + to_string(entry.table_id) : std::string();
  nlohmann::json json{{"id", kind + table + "-" + std::to_string(entry.id)},
                      {"kind", kind},
                      {"name", entry.name},
                      {"deleted", utc_text(entry.deleted)},
                      {"erased", utc_text(entry.deleted + keep)}};
  if (entry.kind == TrashEntry::Kind::layer) {
    json["model"] = entry.model_id;
    json["model_name"] = entry.model_name;
  }
  if (is_record) {
    json["table"] = entry.table_id;
    json["table_name"] = entry.table_name;
  }
  if (!entry.user.empty()) json["user"] = entry.user;
  if (entry.bytes > 0) json["bytes"] = entry.bytes;
  return json;
}

Response to_response(const TrashRestored& restored) {
  const TrashEntry& entry = restored.entry;
  nlohmann::json json{{"kind", name_of(entry.kind)}, {"restored", entry.id}, {"name", entry.name}};
  if (entry.kind == TrashEntry::Kind::layer) json["model"] = entry.model_id;
  if (entry.kind == TrashEntry::Kind::record) json["table"] = entry.table_id;
  if (!restored.slug.empty()) json["slug"] = restored.slug;
  if (!restored.former_slug.empty()) json["former_slug"] = restored.former_slug;
  return json_response(json);
}

Result<std::optional<store::Trash::Place>> trash_place(const Page& page) {
  if (!page.after) return std::nullopt;
  const ListPlace& place = *page.after;
  if (place.size() != 4 ||
      !std::ranges::all_of(place, [](const auto& value) { return value.is_number_integer(); }))
    return wrong_place();
  const auto kind = place[1].get<std::int64_t>();
  if (kind < 0 || kind > static_cast<int>(TrashEntry::Kind::record)) return wrong_place();
  return store::Trash::Place{place[0].get<std::int64_t>(), static_cast<TrashEntry::Kind>(kind),
                             place[2].get<TableId>(), place[3].get<std::int64_t>()};
}

Result<Response> list_trash(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto project = STRATA_TRY(stored_project(context, request));
  const auto after = STRATA_TRY(trash_place(page));
  auto found = STRATA_TRY(context.store.trash().of_project(project.id, sight_of(context, request),
                                                           page.limit + 1, page.offset, after));
  const auto last = end_page(found.entries, page, [](const TrashEntry& entry) {
    const auto deleted =
        std::chrono::duration_cast<std::chrono::microseconds>(entry.deleted.time_since_epoch());
    return ListPlace::array(
        {deleted.count(), static_cast<int>(entry.kind), entry.table_id, entry.id});
  });
  const std::chrono::days keep(context.options.trash_days);
  nlohmann::json entries = nlohmann::json::array();
  for (const TrashEntry& entry : found.entries) entries.push_back(to_json(entry, keep));
  STRATA_TRY(People::add_to(context.store, entries));
  Response response = json_response({{"entries", std::move(entries)},
                                     {"total", found.total},
                                     {"days", context.options.trash_days}});
  add_page_links(response, request, page, last);
  return response;
}

// Returns the two numbers in `5-17`, or the number in `3`. Returns nothing for other text.
std::optional<std::vector<std::int64_t>> numbers_of(std::string_view text) {
  std::vector<std::int64_t> numbers;
  for (;;) {
    std::int64_t number = -1;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || number < 0) return std::nullopt;
    numbers.push_back(number);
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    if (text.empty()) return numbers;
    if (text.front() != '-') return std::nullopt;
    text.remove_prefix(1);
  }
}

// Finds the entry for an address such as `layer-3`, `model-7` or `record-5-17`.
Result<TrashEntry> find_entry(const RouteContext& context, const Request& request) {
  const auto project = STRATA_TRY(stored_project(context, request));
  const std::string_view ref = request.param("entry");
  for (const auto kind :
       {TrashEntry::Kind::layer, TrashEntry::Kind::model, TrashEntry::Kind::record}) {
    const std::string begin = std::string(name_of(kind)) + "-";
    if (!ref.starts_with(begin)) continue;
    const auto numbers = numbers_of(ref.substr(begin.size()));
    const bool is_record = kind == TrashEntry::Kind::record;
    if (!numbers || numbers->size() != (is_record ? 2u : 1u)) break;
    return context.store.trash().entry(project.id, kind, numbers->back(),
                                       TableId(is_record ? numbers->front() : 0),
                                       sight_of(context, request));
  }
  return fail(ErrorCode::not_found, "Not in the Trash",
              "The project's Trash does not contain `" + std::string(ref.substr(0, 100)) + "`.");
}

Result<Response> restore(const RouteContext& context, const Request& request) {
  const auto entry = STRATA_TRY(find_entry(context, request));
  if (entry.kind == TrashEntry::Kind::record) {
    const auto respond = [&](const store::TableChange&) { return to_response({entry, {}, {}}); };
    const auto change = STRATA_TRY(context.store.trash().restore_record(
        entry, request.user(), idempotent_response<store::TableChange>(request, respond)));
    context.changes.records_changed(change, request.user());
    return respond(change);
  }
  const auto answer = idempotent_response<TrashRestored>(request, to_response);
  if (entry.kind == TrashEntry::Kind::model) {
    const auto restored = context.store.trash().restore(entry, answer);
    return restored ? Result<Response>(to_response(*restored)) : tl::unexpected(restored.error());
  }
  // Restores the layer through the room because the room notifies the participants.
  const auto room = STRATA_TRY(context.rooms.open(to_string(entry.model_id), request.role()));
  const auto restored = room->layers().restore(entry, answer);
  return restored ? Result<Response>(to_response(*restored)) : tl::unexpected(restored.error());
}

Result<Response> erase(const RouteContext& context, const Request& request) {
  const auto entry = STRATA_TRY(find_entry(context, request));
  STRATA_TRY(context.store.trash().erase(
      entry, idempotent_response<>(request, [] { return empty_response(204); })));
  context.trash_purger.check_now();
  return empty_response(204);
}

}  // namespace

void add_trash_routes(Router& router, const RouteContext& context) {
  const std::string trash = "/api/v1/projects/{project}/bin", entry = trash + "/{entry}";
  router.add({.method = Method::get,
              .pattern = trash,
              .handler = answering(
                  [&context](const Request& request) { return list_trash(context, request); }),
              .role = Role::annotator,
              .query = {"limit", "offset", "after"}});
  router.add({.method = Method::post,
              .pattern = entry + "/restore",
              .handler = answering(
                  [&context](const Request& request) { return restore(context, request); }),
              .role = Role::annotator,
              .keeps_answer = true});
  router.add(
      {.method = Method::remove,
       .pattern = entry,
       .handler = answering([&context](const Request& request) { return erase(context, request); }),
       .role = Role::curator,
       .keeps_answer = true});
}

}  // namespace strata::net
