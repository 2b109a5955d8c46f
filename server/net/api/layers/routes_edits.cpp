#include "app/authorization/visibility_leak_check.h"
#include "app/strokes/brush_shape_cache.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/http/page.h"
#include "net/serialization/edit_serialization.h"
#include "net/serialization/journal_serialization.h"
#include "net/serialization/people_serialization.h"
#include "net/transport/server_options.h"
#include "room/edit.h"
#include "room/edits.h"
#include "room/layers.h"
#include "room/room.h"
#include "store/journal/journal_reads.h"
#include "store/store.h"

namespace strata::net {
namespace {

Result<Response> history(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto layer = STRATA_TRY(stored_layer(context, request));
  const auto before = STRATA_TRY(number_after(page, INT64_MAX));
  auto rows =
      STRATA_TRY(context.store.journal().history(layer.id, page.limit + 1, page.offset, before));
  const auto last =
      end_page(rows.rows, page, [](const auto& row) { return ListPlace::array({row.sequence}); });
  nlohmann::json list = nlohmann::json::array();
  for (const auto& row : rows.rows) {
    nlohmann::json entry = to_json(row);
    // An old expression may name layers that are now visible to fewer users.
    if (entry.contains("expression")) {
      const auto seen = STRATA_TRY(app::sees_all_of(context.store, request.role(), layer.model_id,
                                                    entry.at("expression").get<std::string>()));
      if (!seen) entry.erase("expression");
    }
    list.push_back(std::move(entry));
  }
  Response response = json_response({{"edits", list}, {"total", rows.total}});
  add_page_links(response, request, page, last);
  return response;
}

Result<Response> list_review(const RouteContext& context, const Request& request) {
  auto page = STRATA_TRY(page_of(request));
  auto layer = STRATA_TRY(stored_layer(context, request));
  std::optional<std::string> user;
  if (const auto parameter = request.query.find("user"); parameter != request.query.end())
    user = parameter->second;
  if (user && (user->empty() || user->size() > 200))
    return fail(ErrorCode::invalid, "Invalid name", "`user` must be the user name of a person.",
                "user");
  const auto after = STRATA_TRY(number_after(page));
  auto queue = STRATA_TRY(
      context.store.journal().review_queue(layer.id, user, page.limit + 1, page.offset, after));
  const auto last = end_page(
      queue.strokes, page, [](const auto& stroke) { return ListPlace::array({stroke.sequence}); });
  nlohmann::json answer = to_json(queue);
  STRATA_TRY(People::add_to(context.store, answer));
  Response response = json_response(answer);
  add_page_links(response, request, page, last);
  return response;
}

struct Target {
  std::shared_ptr<room::Room> room;
  Layer layer;
};

Result<Target> target_of(const RouteContext& context, const Request& request) {
  auto room = STRATA_TRY(open_room(context, request));
  auto layer = STRATA_TRY(room->layers().find(request.param("layer")));
  return Target{std::move(room), std::move(layer)};
}

// Runs `make` for the layer in the path and applies the edit that `make` returns.
template <class Make>
Handler editing(const RouteContext& context, Make make) {
  return [&context, make](const Request& request, const Respond& respond) {
    auto target = target_of(context, request);
    if (!target) return respond(target.error());
    Result<room::EditRequest> edit = make(request, *target);
    if (!edit) return respond(edit.error());
    apply_edit(context, request, target->room, std::move(*edit), respond);
  };
}

room::EditRequest bare_edit(const Request& request, const Target& target, std::string op) {
  room::EditRequest edit{edit_id(request, target.layer, op), request.author(), target.layer.id};
  edit.record = {{"op", std::move(op)}};
  return edit;
}

Result<room::EditRequest> review_edit(const Request& request, const Target& target) {
  const auto body = STRATA_TRY(body_of<protocol::Review>(request));
  const auto decision = *parse_decision(name(body.decision));
  if (decision == Decision::reopen && !body.edits)
    return fail(ErrorCode::invalid, "Edits not specified",
                "Specify the edits whose review you want to undo.", "edits");
  auto edit = bare_edit(request, target, std::string(name(decision)));
  // The same key cannot be used for two decisions.
  edit.id = edit_id(request, target.layer, "review");
  if (body.edits) edit.record["edits"] = *body.edits;
  if (body.user) edit.record["user"] = *body.user;
  if (body.reason) edit.record["reason"] = *body.reason;
  edit.edit = room::ReviewEdit{decision,
                               {body.edits.value_or(std::vector<std::int64_t>{}), body.user},
                               body.reason.value_or("")};
  return edit;
}

// The bodies of undo and redo have no members. An absent body is equivalent to an empty object.
Result<void> check_empty(const Request& request) {
  if (request.body.empty()) return {};
  STRATA_TRY(body_of<protocol::Empty>(request));
  return {};
}

}  // namespace

void add_edit_routes(Router& router, const RouteContext& context) {
  const std::string layer = "/api/v1/models/{model}/layers/{layer}";
  auto change = [&](const std::string& pattern, Handler handler, Role role = Role::annotator) {
    router.add({.method = Method::post,
                .pattern = pattern,
                .handler = std::move(handler),
                .role = role,
                .body = BodyKind::memory,
                .max_body = context.options.max_json_bytes,
                .is_long_edit = true});
  };
  router.add({.method = Method::get,
              .pattern = layer + "/edits",
              .handler = answering(
                  [&context](const Request& request) { return history(context, request); }),
              .query = {"limit", "offset", "after"}});
  change(layer + "/edits",
         editing(
             context,
             [&context](const Request& request, const Target& target) -> Result<room::EditRequest> {
               auto body = STRATA_TRY(body_of<protocol::Edit>(request));
               return edit_request(body, target.layer, target.room->model(),
                                   edit_id(request, target.layer, "edit"), request.author(),
                                   [&](const std::string& ref) { return context.tools.find(ref); });
             }));
  router.add({.method = Method::get,
              .pattern = layer + "/review",
              .handler = answering(
                  [&context](const Request& request) { return list_review(context, request); }),
              .query = {"user", "limit", "offset", "after"}});
  change(layer + "/review", editing(context, review_edit), Role::curator);
  change(layer + "/undo",
         editing(context,
                 [](const Request& request, const Target& target) -> Result<room::EditRequest> {
                   STRATA_TRY(check_empty(request));
                   auto edit = bare_edit(request, target, "undo");
                   edit.edit = room::UndoEdit{};
                   return edit;
                 }));
  change(layer + "/redo",
         editing(context,
                 [](const Request& request, const Target& target) -> Result<room::EditRequest> {
                   STRATA_TRY(check_empty(request));
                   auto edit = bare_edit(request, target, "redo");
                   edit.edit = room::RedoEdit{};
                   return edit;
                 }));
  change(layer + "/restore",
         editing(context,
                 [](const Request& request, const Target& target) -> Result<room::EditRequest> {
                   auto body = STRATA_TRY(body_of<protocol::Restore>(request));
                   if (body.sequence > target.room->edits().sequence())
                     return fail(ErrorCode::invalid, "Sequence out of range",
                                 "The newest sequence of this model is " +
                                     std::to_string(target.room->edits().sequence()) + ".",
                                 "sequence");
                   auto edit = bare_edit(request, target, "restore");
                   edit.record["sequence"] = body.sequence;
                   room::RestoreEdit restore{body.sequence, {}};
                   if (body.within) {
                     STRATA_TRY(validate(body.within->camera));
                     edit.record["within"] = protocol::to_json(*body.within);
                     restore.outline = room::Outline{body.within->camera, body.within->path,
                                                     body.within->through};
                   }
                   edit.edit = std::move(restore);
                   return edit;
                 }));
}

}  // namespace strata::net
