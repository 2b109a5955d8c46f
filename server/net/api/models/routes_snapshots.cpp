// Snapshots, which are named states of a model. Viewers can read them, and annotators can create
// them. Authors can change their own snapshots. Curators can change all of them.
#include "core/text/timestamp.h"
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/live_sockets.h"
#include "net/serialization/as_of.h"
#include "room/edits.h"
#include "room/room.h"
#include "store/content/named_parts.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::net {
namespace {

using protocol::SnapshotEventEvent;
using store::NamedPart;

nlohmann::json to_json(const Request& request, const NamedPart& snapshot) {
  nlohmann::json json = snapshot.content;
  json.update({{"id", snapshot.id},
               {"slug", snapshot.slug},
               {"name", snapshot.name},
               {"text", snapshot.text},
               {"user", visible_name(request, snapshot.user)},
               {"time", utc_text(snapshot.time)},
               {"version", snapshot.version}});
  return json;
}

Result<NamedPart> find_snapshot(const RouteContext& context, const Request& request) {
  const auto model = STRATA_TRY(stored_model(context, request));
  return context.store.snapshots().find(model.id, request.param("snapshot"));
}

Result<NamedPart> find_own_snapshot(const RouteContext& context, const Request& request) {
  auto snapshot = STRATA_TRY(find_snapshot(context, request));
  STRATA_TRY(check_if_match(request, snapshot.version));
  if (snapshot.user != request.user() && request.role() < Role::curator)
    return fail(
        ErrorCode::forbidden, "Not allowed",
        "Only " + snapshot.user +
            " and curators can change this snapshot. Create your own snapshot of this state.");
  return snapshot;
}

Result<Response> list_snapshots(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto after = STRATA_TRY(number_after(page));
  auto found =
      STRATA_TRY(context.store.snapshots().of_model(model.id, page.limit + 1, page.offset, after));
  const auto last = end_page(
      found.parts, page, [](const NamedPart& snapshot) { return ListPlace::array({snapshot.id}); });
  nlohmann::json snapshots = nlohmann::json::array();
  for (const NamedPart& snapshot : found.parts) snapshots.push_back(to_json(request, snapshot));
  Response response = json_response({{"snapshots", std::move(snapshots)}, {"total", found.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> get_snapshot(const RouteContext& context, const Request& request) {
  const auto snapshot = STRATA_TRY(find_snapshot(context, request));
  return with_etag(json_response(to_json(request, snapshot)), request, snapshot.version);
}

// Converts a state to its stored format. Refuses states that are not in the journal yet. The
// journal may still refuse the edits of such a state.
Result<nlohmann::json> content_of(const RouteContext& context, const room::Room& room,
                                  const std::optional<protocol::At>& at) {
  const std::int64_t durable = room.edits().durable_sequence();
  const auto requested = STRATA_TRY(find_sequence(context, room, at));
  const std::int64_t sequence = requested.value_or(durable);
  if (sequence > durable)
    return fail(ErrorCode::conflict, "Not saved yet",
                "The server is still saving the edits of this state. Try again in a moment.", "at");
  nlohmann::json content{{"sequence", sequence}};
  const auto time = STRATA_TRY(context.store.journal().time_of_state(room.model().id, sequence));
  if (time) content["state_time"] = utc_text(*time);
  return content;
}

void tell(const RouteContext& context, SnapshotEventEvent event, const NamedPart& snapshot,
          const std::string& user) {
  protocol::SnapshotEvent message;
  message.event = event;
  message.snapshot = snapshot.id.number();
  message.user = user;
  context.live_sockets.tell_model(snapshot.model_id, message);
}

Result<Response> create_snapshot(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::SnapshotCreate>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  NamedPart snapshot;
  snapshot.model_id = room->model().id;
  snapshot.name = body.name;
  snapshot.text = body.text.value_or("");
  snapshot.content = STRATA_TRY(content_of(context, *room, body.at));
  snapshot.user = request.user();
  const auto answer = [&](const NamedPart& made) {
    return json_response(to_json(request, made), 201)
        .with("Location", "/api/v1/models/" + room->model().slug + "/snapshots/" + made.slug)
        .with("ETag", etag_of(made.version));
  };
  const auto made = STRATA_TRY(
      context.store.snapshots().create(snapshot, idempotent_response<NamedPart>(request, answer)));
  tell(context, SnapshotEventEvent::created, made, request.user());
  return answer(made);
}

Result<Response> change_snapshot(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::SnapshotPatch>(request));
  auto snapshot = STRATA_TRY(find_own_snapshot(context, request));
  if (body.name) snapshot.name = *body.name;
  if (body.text) snapshot.text = *body.text;
  const auto answer = [&](const NamedPart& now) {
    return json_response(to_json(request, now)).with("ETag", etag_of(now.version));
  };
  const auto changed = STRATA_TRY(
      context.store.snapshots().update(snapshot, idempotent_response<NamedPart>(request, answer)));
  tell(context, SnapshotEventEvent::changed, changed, request.user());
  return answer(changed);
}

Result<Response> delete_snapshot(const RouteContext& context, const Request& request) {
  const auto snapshot = STRATA_TRY(find_own_snapshot(context, request));
  const auto answer = [] { return empty_response(204); };
  STRATA_TRY(context.store.snapshots().remove(snapshot, idempotent_response<>(request, answer)));
  tell(context, SnapshotEventEvent::deleted, snapshot, request.user());
  return answer();
}

}  // namespace

void add_snapshot_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context);
  const std::string snapshots = "/api/v1/models/{model}/snapshots",
                    snapshot = snapshots + "/{snapshot}";
  routes.read(snapshots, list_snapshots, {"limit", "offset", "after"});
  routes.change(Method::post, snapshots, create_snapshot);
  routes.read(snapshot, get_snapshot);
  routes.change(Method::patch, snapshot, change_snapshot);
  routes.change(Method::remove, snapshot, delete_snapshot);
}

}  // namespace strata::net
