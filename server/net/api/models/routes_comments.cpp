// Comment threads of a model. Viewers can read them, and annotators can write them. Authors can
// change their own comments. Curators can delete all comments.
#include <set>

#include "core/log.h"
#include "core/no_such.h"
#include "core/text/timestamp.h"
#include "domain/layers/layer.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "domain/scene/model.h"
#include "domain/tables/table.h"
#include "net/api/addressed.h"
#include "net/api/annotated_routes.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/auth/project_authorization.h"
#include "net/http/idempotency_store.h"
#include "net/http/page.h"
#include "net/live/comment_events.h"
#include "net/live/live_sockets.h"
#include "net/serialization/people_serialization.h"
#include "room/queries.h"
#include "room/room.h"
#include "store/content/comments.h"
#include "store/store.h"
#include "store/tables/records.h"

namespace strata::net {
namespace {

using protocol::CommentEventEvent;
using store::Comment;
using store::Comments;

constexpr double kMaxDistance = 0.05;  // from the surface, as a fraction of the model's diagonal

nlohmann::json to_json(const glm::dvec3& point) { return {point.x, point.y, point.z}; }

nlohmann::json to_json(const Comment& comment) {
  nlohmann::json json{
      {"id", comment.id},          {"model", comment.model_id},      {"text", comment.text},
      {"user", comment.user},      {"time", utc_text(comment.time)}, {"deleted", comment.deleted},
      {"version", comment.version}};
  if (comment.thread) json["thread"] = *comment.thread;
  if (comment.place) {
    json["position"] = to_json(comment.place->position);
    json["normal"] = to_json(comment.place->normal);
    json["state"] = comment.resolved ? "resolved" : "open";
  }
  if (comment.layer_id) json["layer"] = *comment.layer_id;
  if (comment.table_id && comment.record) {
    json["table"] = *comment.table_id;
    json["record"] = *comment.record;
  }
  if (comment.resolved)
    json["resolved"] = {{"user", comment.resolved->user},
                        {"time", utc_text(comment.resolved->time)}};
  if (comment.edited) json["edited"] = utc_text(*comment.edited);
  return json;
}

// Returns the users whose names may occur in a comment and in a change to it.
Result<People> people_of(store::Store& store, const Comment& comment, const std::string& asking) {
  std::vector<std::string> names{comment.user, asking};
  if (comment.resolved) names.push_back(comment.resolved->user);
  return People::load(store, names);
}

nlohmann::json to_json(const Comment& comment, const People& people) {
  nlohmann::json json = to_json(comment);
  people.add(json);
  return json;
}

Result<Response> page_response(const RouteContext& context, const Request& request,
                               const char* list, Comments::Page found, const Page& page) {
  const auto last = end_page(found.comments, page,
                             [](const Comment& comment) { return ListPlace::array({comment.id}); });
  nlohmann::json comments = nlohmann::json::array();
  for (const Comment& comment : found.comments) comments.push_back(to_json(comment));
  STRATA_TRY(People::add_to(context.store, comments));
  Response response = json_response({{list, std::move(comments)}, {"total", found.total}});
  add_page_links(response, request, page, last);
  return response;
}

void tell(LiveSockets& sockets, CommentEventEvent event, const Comment& comment,
          const People& people, const std::string& user) {
  protocol::CommentEvent message;
  message.event = event;
  message.comment_id = comment.id.number();
  message.comment = to_json(comment, people);
  message.user = user;
  sockets.tell_model(comment.model_id, comment.visibility, message);
}

Result<Comment> stored_comment(const RouteContext& context, const Request& request) {
  const auto id = STRATA_TRY(id_of<CommentId>(request, "comment"));
  return context.store.comments().comment(id, request.role());
}

Result<Response> list_comments(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  Comments::Query query;
  const auto after = STRATA_TRY(number_after(page));
  query.limit = page.limit + 1;
  query.offset = page.offset;
  query.after = after;
  if (const auto state = request.query.find("state"); state != request.query.end()) {
    if (state->second != "open" && state->second != "resolved")
      return fail(ErrorCode::invalid, "Invalid state", "`state` must be open or resolved.",
                  "state");
    query.resolved = state->second == "resolved";
  }
  query.since = STRATA_TRY(time_of(request, "since"));
  const auto model = STRATA_TRY(stored_model(context, request));
  const auto found = STRATA_TRY(context.store.comments().of_model(model.id, request.role(), query));
  return page_response(context, request, "comments", found, page);
}

Result<Response> list_replies(const RouteContext& context, const Request& request) {
  const auto page = STRATA_TRY(page_of(request));
  const auto thread = STRATA_TRY(stored_comment(context, request));
  const auto after = STRATA_TRY(number_after(page));
  auto found = STRATA_TRY(context.store.comments().replies(thread.id, request.role(),
                                                           page.limit + 1, page.offset, after));
  return page_response(context, request, "replies", found, page);
}

Result<Comment::Place> place_on(room::Room& room, const glm::dvec3& world) {
  const auto nearest = STRATA_TRY(room.queries().position(world, {}));
  const Model model = room.model();
  const double farthest = kMaxDistance * glm::length(model.bounds_max - model.bounds_min);
  if (!nearest.hit || nearest.distance > farthest)
    return fail(
        ErrorCode::invalid, "Not on the model",
        "`position` must be in world coordinates. Its distance from the surface must be at most "
        "5 % of the model's diagonal.",
        "position");
  return Comment::Place{nearest.position, glm::dvec3(nearest.normal)};
}

// Sets the layer and the record that the request body names.
Result<void> put_subject(const RouteContext& context, const room::Room& room,
                         const protocol::CommentCreate& body, Comment& comment) {
  if (!body.layer) {
    if (body.record)
      return fail(ErrorCode::invalid, "Record without a layer",
                  "`record` is the key of a record of a layer. Also send `layer`.", "layer");
    return {};
  }
  const auto layers = STRATA_TRY(find_layers(room, {protocol::to_ref(*body.layer)}, "layer"));
  const Layer& layer = layers.front();
  comment.layer_id = layer.id;
  if (!body.record) return {};
  if (!layer.table)
    return fail(ErrorCode::invalid, "Layer has no records",
                "The layer `" + layer.slug + "` is numeric, so it has no records.", "record");
  const auto missing =
      STRATA_TRY(context.store.records().missing(*layer.table, std::vector{*body.record}));
  if (!missing.empty())
    return fail(
        ErrorCode::invalid, "Record not found",
        "The table of `" + layer.slug + "` has no record " + std::to_string(*body.record) + ".",
        "record");
  comment.table_id = *layer.table;
  comment.record = *body.record;
  return {};
}

Result<Response> write(const RouteContext& context, const Request& request,
                       const Comment& comment) {
  const auto people = STRATA_TRY(people_of(context.store, comment, request.user()));
  const auto answer = [&people](const Comment& made) {
    return json_response(to_json(made, people), 201)
        .with("Location", "/api/v1/comments/" + to_string(made.id))
        .with("ETag", etag_of(made.version));
  };
  const auto written =
      context.store.comments().create(comment, idempotent_response<Comment>(request, answer));
  if (!written) return tl::unexpected(written.error());
  tell(context.live_sockets, CommentEventEvent::created, *written, people, request.user());
  return answer(*written);
}

Result<Response> create_comment(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::CommentCreate>(request));
  const auto room = STRATA_TRY(open_room(context, request));
  const auto place = STRATA_TRY(place_on(*room, body.position));
  Comment comment;
  comment.model_id = room->model().id;
  comment.place = place;
  STRATA_TRY(put_subject(context, *room, body, comment));
  comment.text = body.text;
  comment.user = request.user();
  return write(context, request, comment);
}

Result<Response> create_reply(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::ReplyCreate>(request));
  const auto thread = STRATA_TRY(stored_comment(context, request));
  Comment comment;
  comment.thread = thread.id;
  comment.text = body.text;
  comment.user = request.user();
  return write(context, request, comment);
}

Result<Response> change_comment(const RouteContext& context, const Request& request) {
  const auto body = STRATA_TRY(body_of<protocol::CommentPatch>(request));
  auto comment = STRATA_TRY(stored_comment(context, request));
  STRATA_TRY(check_if_match(request, comment.version));
  if (body.text) {
    if (comment.user != request.user())
      return fail(
          ErrorCode::forbidden, "Not allowed",
          "Only " + comment.user + " can change the text of this comment. Write a reply instead.",
          "text");
    if (comment.deleted)
      return fail(
          ErrorCode::conflict, "Already deleted",
          "Somebody deleted this comment. The page still shows its place because it has replies.",
          "text");
    comment.text = *body.text;
  }
  if (body.state) {
    if (comment.thread)
      return fail(ErrorCode::invalid, "Reply has no state",
                  "Only the first comment of a thread has a state. Change comment " +
                      to_string(*comment.thread) + ".",
                  "state");
    if (*body.state == protocol::CommentState::open)
      comment.resolved.reset();
    else if (!comment.resolved)
      comment.resolved = Comment::Resolution{request.user(), {}};
  }
  const auto people = STRATA_TRY(people_of(context.store, comment, request.user()));
  const auto answer = [&people](const Comment& now) {
    return json_response(to_json(now, people)).with("ETag", etag_of(now.version));
  };
  const auto changed =
      context.store.comments().update(comment, idempotent_response<Comment>(request, answer));
  if (!changed) return tl::unexpected(changed.error());
  tell(context.live_sockets, CommentEventEvent::changed, *changed, people, request.user());
  return answer(*changed);
}

Result<Response> delete_comment(const RouteContext& context, const Request& request) {
  const auto comment = STRATA_TRY(stored_comment(context, request));
  STRATA_TRY(check_if_match(request, comment.version));
  if (comment.user != request.user() && request.principal->role < Role::curator)
    return fail(ErrorCode::forbidden, "Not allowed",
                "Only " + comment.user + " and curators can delete this comment.");
  const auto answer = [](const Comments::Removal&) { return empty_response(204); };
  const auto removal = context.store.comments().remove(
      comment, idempotent_response<Comments::Removal>(request, answer));
  if (!removal) return tl::unexpected(removal.error());
  if (removal->left) {
    const auto people = people_of(context.store, *removal->left, request.user());
    tell(context.live_sockets, CommentEventEvent::changed, *removal->left,
         people.value_or(People()), request.user());
  }
  for (const auto id : removal->gone)
    tell_comment_deleted(context.live_sockets, removal->model_id, id, request.user());
  return answer(*removal);
}

}  // namespace

void tell_threads(const RouteContext& context, const Layer& layer, Visibility before,
                  const std::string& user) {
  if (layer.visibility == before) return;
  Comments::Query all;
  all.limit = static_cast<int>(Comments::kMaxComments);
  const auto found = context.store.comments().of_model(layer.model_id, Role::owner, all);
  if (!found)
    return log::warning("threads about layer " + to_string(layer.id) + ": " + found.error().detail);
  std::set<CommentId> threads;
  for (const Comment& comment : found->comments)
    if (comment.layer_id == layer.id) threads.insert(comment.id);
  std::vector<std::string> names;
  for (const Comment& comment : found->comments) {
    names.push_back(comment.user);
    if (comment.resolved) names.push_back(comment.resolved->user);
  }
  const auto people = People::load(context.store, names);
  if (!people)
    return log::warning("threads about layer " + to_string(layer.id) + ": " +
                        people.error().detail);
  for (const Comment& comment : found->comments) {
    if (!threads.contains(comment.thread.value_or(comment.id))) continue;
    protocol::CommentEvent message;
    message.comment_id = comment.id.number();
    message.user = user;
    const bool is_seen_by_more = layer.visibility < before;
    message.event = is_seen_by_more ? CommentEventEvent::changed : CommentEventEvent::deleted;
    if (is_seen_by_more) message.comment = to_json(comment, *people);
    const auto is_meant = [&](Role role) {
      return sees(role, before) != sees(role, layer.visibility);
    };
    for (const Visibility sight : {Visibility::everyone, Visibility::team, Visibility::curators})
      if (is_meant(least_role(sight)))
        context.live_sockets.tell_sight(layer.model_id, sight, message);
  }
}

Result<void> tell_comment(store::Store& store, LiveSockets& sockets, CommentEventEvent event,
                          CommentId id, const std::string& user) {
  const auto comment = store.comments().comment(id, Role::owner);
  if (!comment && comment.error().code == ErrorCode::not_found) return {};
  if (!comment) return tl::unexpected(comment.error());
  const auto people = STRATA_TRY(people_of(store, *comment, user));
  tell(sockets, event, *comment, people, user);
  return {};
}

void tell_comment_deleted(LiveSockets& sockets, ModelId model, CommentId id,
                          const std::string& user) {
  protocol::CommentEvent message;
  message.event = CommentEventEvent::deleted;
  message.comment_id = id.number();
  message.user = user;
  sockets.tell_model(model, message);
}

void add_comment_routes(Router& router, const RouteContext& context) {
  AnnotatedRoutes routes(router, context);
  const std::string of_model = "/api/v1/models/{model}/comments",
                    comment = "/api/v1/comments/{comment}";
  routes.read(of_model, list_comments, {"state", "since", "limit", "offset", "after"});
  routes.change(Method::post, of_model, create_comment);
  routes.read(comment, [](const RouteContext& of, const Request& request) -> Result<Response> {
    const auto found = STRATA_TRY(stored_comment(of, request));
    nlohmann::json answer = to_json(found);
    STRATA_TRY(People::add_to(of.store, answer));
    return with_etag(json_response(answer), request, found.version);
  });
  routes.change(Method::patch, comment, change_comment);
  routes.change(Method::remove, comment, delete_comment);
  routes.read(comment + "/replies", list_replies, {"limit", "offset", "after"});
  routes.change(Method::post, comment + "/replies", create_reply);
}

}  // namespace strata::net
