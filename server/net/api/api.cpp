#include "net/api/api.h"
#include "jobs/demo.h"

#include <exception>

#include "app/nodes/node_lease.h"
#include "core/log.h"
#include "core/no_such.h"
#include "net/api/models/personal_view.h"
#include "net/api/node_redirect.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/api/site/routes_demo.h"
#include "net/auth/audit_trail.h"
#include "net/auth/kiosk_authorization.h"
#include "net/auth/project_authorization.h"
#include "net/auth/session_recheck.h"
#include "net/http/accept.h"
#include "net/http/compression.h"
#include "net/http/entity_tags.h"
#include "net/http/origin.h"
#include "net/http/precondition.h"
#include "net/serialization/people_serialization.h"
#include "room/participants.h"
#include "room/rooms.h"
#include "store/content/projects.h"
#include "store/nodes/nodes.h"
#include "store/people/accounts.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::net {
namespace {

constexpr std::size_t kMaxKey = 255;
constexpr std::size_t kMaxWaitingQueries = 256;

bool changes(Method method) {
  return method != Method::get && method != Method::head && method != Method::options;
}

Response refusal(const Error& error, const Request& request) {
  if (error.code != ErrorCode::moved) return problem_response(error);
  return redirected_by_handler(error.location, request.target, request.was_moved);
}

Result<void> check_record(store::Store& store, ProjectId project_id,
                          const app::RecordEditLocks::Record& record) {
  const auto table = store.tables().find(to_string(record.table), Role::viewer);
  if (!table && table.error().code != ErrorCode::not_found) return tl::unexpected(table.error());
  if (!table || table->project_id != project_id)
    return no_such("table", to_string(record.table), "table");
  const auto missing = STRATA_TRY(store.records().missing(record.table, std::vector{record.key}));
  if (!missing.empty()) return no_such("record", std::to_string(record.key), "key");
  return {};
}

std::shared_ptr<LiveShared> make_shared_state(const ServerOptions& options, store::Store& store,
                                              const std::shared_ptr<app::BrushShapeCache>& tools) {
  auto shared = std::make_shared<LiveShared>();
  shared->metrics = std::make_shared<Metrics>();
  shared->strokes = std::make_shared<app::StrokeTracker>();
  shared->queries = std::make_shared<WorkerPool>(options.query_threads, kMaxWaitingQueries);
  shared->sockets = std::make_shared<LiveSockets>();
  shared->editors = std::make_shared<app::RecordEditLocks>();
  shared->store = &store;
  shared->limits = options.live;
  shared->find_tool = [tools](const std::string& ref) { return tools->find(ref); };
  shared->check_record = [&store](ProjectId project_id,
                                  const app::RecordEditLocks::Record& record) {
    return check_record(store, project_id, record);
  };
  return shared;
}

constexpr std::string_view kPolicy =
    "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; "
    "form-action 'self'; frame-ancestors 'none'";
// Redoc, which shows the documentation of the API, adds two style elements. One is empty and is
// filled by a script. The other contains the style of the scroll bars. The policy contains the
// hashes of these two texts. All other style elements and all style attributes remain forbidden.
constexpr std::string_view kStylesOfDocs =
    "; style-src 'self' 'sha256-47DEQpj8HBSa+/TImW+5JCeuQeRkm5NMpJWZG3hSuFU=' "
    "'sha256-QMIg+bpjm3JdElJ388KYke01izlUW0UoNOeKjpMxdgc='";

}  // namespace

const Headers& security_headers() {
  static const Headers headers = {
      {"Content-Security-Policy", std::string(kPolicy)},
      {"X-Content-Type-Options", "nosniff"},
      {"Referrer-Policy", "no-referrer"},
      {"Cross-Origin-Opener-Policy", "same-origin"},
      {"Cross-Origin-Resource-Policy", "same-origin"},
      // Disables the browser features that the pages do not use.
      {"Permissions-Policy",
       "accelerometer=(), camera=(), display-capture=(), geolocation=(), gyroscope=(), magnetometer=(), "
       "microphone=(), midi=(), payment=(), serial=(), usb=(), xr-spatial-tracking=()"},
  };
  return headers;
}

Api::Api(ServerOptions options, store::Store& store, room::Rooms& rooms, jobs::JobQueue& jobs,
         render::Renderer& renderer, app::TemplateRegistry templates)
    : options_(std::move(options)),
      own_names_(own_names(options_.host, options_.allowed_origins)),
      store_(store),
      rooms_(rooms),
      auth_(store, options_.owner_token, options_.local_accounts),
      answers_(store),
      edit_book_(store),
      files_(options_.static_dir),
      tools_(std::make_shared<app::BrushShapeCache>(store)),
      templates_(std::move(templates)),
      shared_(make_shared_state(options_, store, tools_)),
      workers_(options_.worker_threads, options_.max_waiting_requests),
      questions_({.threads = options_.question_threads, .waiting = options_.max_waiting_requests}),
      sign_ons_(options_.sign_on_providers),
      trash_purger_(store.trash(), std::chrono::days(options_.trash_days), store.audit(),
                    std::chrono::days(options_.audit_days), store.files(),
                    std::chrono::days(options_.file_days)),
      journal_upkeep_(store, rooms, options_.merge_after),
      table_events_(rooms, *shared_->sockets),
      context_{{store, rooms, shared_->metrics->edits, table_events_},
               options_,
               jobs,
               renderer,
               auth_,
               edit_book_,
               *shared_->sockets,
               *shared_->metrics,
               workers_,
               questions_,
               *tools_,
               templates_,
               trash_purger_},
      recomputer_(context_),
      demo_annotators_(context_),
      node_events_(store, rooms, auth_, *shared_->sockets, table_events_),
      node_listener_(listen_to_nodes()) {
  add_system_routes(router_, context_);
  add_auth_routes(router_, context_);
  add_sign_on_routes(router_, context_, sign_ons_);
  add_people_routes(router_, context_);
  add_personal_view_routes(router_, context_);
  add_project_routes(router_, context_);
  add_member_routes(router_, context_);
  add_group_routes(router_, context_);
  add_node_routes(router_, context_);
  add_activity_routes(router_, context_);
  add_audit_routes(router_, context_);
  add_trash_routes(router_, context_);
  add_model_routes(router_, context_);
  add_metadata_routes(router_, context_);
  add_object_routes(router_, context_);
  add_bill_routes(router_, context_);
  add_import_routes(router_, context_);
  add_job_routes(router_, context_);
  add_layer_routes(router_, context_);
  add_surface_image_routes(router_, context_);
  add_comment_routes(router_, context_);
  add_view_routes(router_, context_);
  add_tour_routes(router_, context_);
  add_tour_file_routes(router_, context_);
  add_kiosk_routes(router_, context_);
  add_tool_routes(router_, context_);
  add_table_routes(router_, context_);
  add_term_routes(router_, context_);
  add_template_routes(router_, context_);
  add_demo_routes(router_, context_);
  add_record_routes(router_, context_);
  add_attachment_routes(router_, context_);
  add_attachment_match_routes(router_, context_);
  add_edit_routes(router_, context_);
  add_query_routes(router_, context_);
  add_statistics_routes(router_, context_);
  add_quantity_routes(router_, context_);
  add_extent_routes(router_, context_);
  add_feature_routes(router_, context_);
  add_vertex_routes(router_, context_);
  add_selection_routes(router_, context_);
  add_snapshot_routes(router_, context_);
  add_timeline_routes(router_, context_);
  add_frame_routes(router_, context_);
  add_export_routes(router_, context_);
  add_figure_routes(router_, context_);
  add_layer_preview_routes(router_, context_);
  add_rollout_routes(router_, context_);
  add_texel_routes(router_, context_);
  add_change_routes(router_, context_);
  add_cleanup_routes(router_, context_);
  add_analysis_routes(router_, context_);
  add_shape_routes(router_, context_);
  add_map_routes(router_, context_);
  add_orthophoto_routes(router_, context_);
  add_photograph_routes(router_, context_);
  add_linked_routes(router_, context_);
  add_annotation_routes(router_, context_);
  add_ogc_routes(router_, context_);
  add_ogc_item_routes(router_, context_);
  add_ogc_coverage_routes(router_, context_);
  add_ogc_query_routes(router_, context_);
  page_.pattern = "/";
  page_.role = std::nullopt;
  page_.any_query = true;
  page_.handler = [this](const Request& request, const Respond& respond) {
    respond(files_.serve(request));
  };
  for (const char* pattern : {"/docs", "/api/v1/docs"})
    router_.add({.method = Method::get,
                 .pattern = pattern,
                 .handler =
                     [this](const Request& request, const Respond& respond) {
                       Response page = files_.serve(request);
                       page.with("Content-Security-Policy",
                                 std::string(kPolicy) + std::string(kStylesOfDocs));
                       respond(std::move(page));
                     },
                 .role = std::nullopt});
  live_.pattern = "/api/v1/models/{model}/live";
}

Api::~Api() { stop_workers(); }

std::unique_ptr<app::NodeListener> Api::listen_to_nodes() {
  if (!options_.lease) return nullptr;
  const auto receive = [this](const store::NodeMessage& message, std::chrono::nanoseconds age) {
    auto received = node_events_.receive(message);
    if (received) {
      ++metrics().node_messages;
      metrics().node_message_ages.add(age);
    }
    return received;
  };
  const auto start_over = [this] {
    auto begun = node_events_.start_over();
    if (begun) ++metrics().node_messages_missed;
    return begun;
  };
  return std::make_unique<app::NodeListener>(store_.nodes().messages(options_.lease->node().id),
                                             app::NodeListener::Handlers{receive, start_over});
}

void Api::stop_workers() {
  store_.files().stop_uploads();
  if (node_listener_) node_listener_->stop();
  recomputer_.stop();
  demo_annotators_.stop();
  trash_purger_.stop();
  journal_upkeep_.stop();
  questions_.stop();
  sign_ons_.stop();
  workers_.stop();
  shared_->queries->stop();
}

const Route* Api::find_route(Request& request, Response& refusal) const {
  if (auto own = check_host(request, own_names_); !own) {
    refusal = problem_response(own.error());
    return nullptr;
  }
  forget_codings(request);
  const bool is_api = !request.segments.empty() && request.segments.front() == "api";
  if (request.method == Method::unknown) {
    refusal = problem_response({ErrorCode::method_not_allowed,
                                "Unknown method",
                                "Use GET, HEAD, POST, PUT, PATCH, DELETE or OPTIONS.",
                                {}});
    return nullptr;
  }
  if (is_live_address(request) && request.method == Method::get) {
    refusal = problem_response(
        {ErrorCode::upgrade_required,
         "Upgrade required",
         "This address accepts only WebSocket connections with the subprotocol strata.v1.",
         {}});
    refusal.with("Upgrade", "websocket");
    return nullptr;
  }
  Router::Match match = router_.find(request.method, request.segments);
  if (match.route) {
    request.params = std::move(match.params);
    return match.route;
  }
  if (match.allowed.empty() && !is_api)
    match.allowed = {Method::get, Method::head, Method::options};
  if (match.allowed.empty()) {
    refusal = problem_response({ErrorCode::not_found,
                                "Not found",
                                "The server has nothing at " + request.path +
                                    ". See the list of addresses at /api/v1/docs.",
                                {}});
    return nullptr;
  }
  if (!is_api && (request.method == Method::get || request.method == Method::head)) return &page_;
  const std::string allow = allow_header(match.allowed);
  if (request.method == Method::options) {
    refusal = empty_response(204);
  } else {
    refusal = problem_response({ErrorCode::method_not_allowed,
                                "Method not allowed",
                                "This address accepts: " + allow + ".",
                                {}});
  }
  refusal.with("Allow", allow);
  return nullptr;
}

Result<void> Api::identify(Request& request, const Route& route) {
  STRATA_TRY(check_has_lease(context_, request));
  auto principal = STRATA_TRY(auth_.identify(request));
  request.principal = std::move(principal);
  if (!request.principal)
    return fail(ErrorCode::unauthenticated, "Not signed in",
                "Sign in, or send `Authorization: Bearer TOKEN`.");
  STRATA_TRY(check_job_is_here(context_, request));
  auto inside = request.principal->kiosk ? enter_as_kiosk(context_, request, route)
                                         : enter_project(context_, request, route.project_in_query);
  if (!inside) return inside;
  const Role least = *route.role;
  if (request.principal->role < least)
    return fail(ErrorCode::forbidden, "Not allowed",
                "This action requires the role " + std::string(name(least)) + ". Your role is " +
                    std::string(name(request.principal->role)) + ".");
  return {};
}

std::optional<Response> Api::admit(Request& request, const Route& route) {
  // Public routes, such as the page, sign-in and health, must work even with an invalid cookie.
  if (route.role)
    if (auto known = identify(request, route); !known) return refusal(known.error(), request);
  if (changes(request.method))
    if (auto own = check_same_origin(request, options_.allowed_origins); !own)
      return problem_response(own.error());
  // Redirects before the body is read, so an upload is sent only once.
  if (auto elsewhere = redirect_to_owner(rooms_, request)) return elsewhere;
  if (auto known = check_query(route, request); !known) return problem_response(known.error());
  if (auto named = check_precondition(context_, request, route); !named)
    return problem_response(named.error());
  if (route.check)
    if (auto good = route.check(request); !good) return problem_response(good.error());
  if (request.header("idempotency-key").size() > kMaxKey)
    return problem_response({ErrorCode::malformed, "Key too long",
                             "An Idempotency-Key can have at most 255 characters.",
                             "Idempotency-Key"});
  return std::nullopt;
}

std::optional<Response> Api::admit_again(Request& request, const Route& route) {
  if (!route.role) return std::nullopt;
  const std::string user = request.user();
  if (auto known = identify(request, route); !known) return refusal(known.error(), request);
  if (request.user() != user)
    return problem_response({ErrorCode::unauthenticated,
                             "Not signed in",
                             "Another person is signed in now. Reload the page.",
                             {}});
  return std::nullopt;
}

void Api::handle(const Request& request, const Route& route, const Respond& send) {
  const bool reads = request.method == Method::get || request.method == Method::head;
  const store::ActingAs acting(actor_of(request));
  const Respond respond(
      [this, &request, send, target = request.target, again = request.was_moved,
       coding = std::string(request.header("accept-encoding")), known = request.known_tags,
       accept = reads ? std::string(request.header("accept")) : std::string()](Response response) {
        if (response.status == 307)
          response = redirected_by_handler(response.header("Location"), target, again);
        // Checked only for reads, because a client can repeat them with another `Accept`.
        if (response.status == 200 && !response.events &&
            !accepts_type(accept, response.header("Content-Type")))
          response = problem_response({ErrorCode::not_acceptable, "Not acceptable",
                                       "This address answers with " +
                                           std::string(response.header("Content-Type")) +
                                           ", but `Accept` does not allow this.",
                                       "Accept"});
        // Only handlers that respond before they return send files, so the request still exists.
        if (!response.header("Content-Disposition").empty())
          if (auto audited = audit_export(context_, request, response); !audited)
            response = problem_response(audited.error());
        compress(response, coding, known);
        send(std::move(response));
      });
  if (reads)
    return answer_failures(request, respond, [&] { answer_read(request, route, respond); });
  const bool remembered = route.keeps_answer && !request.header("idempotency-key").empty();
  if (remembered) {
    auto stored = answers_.begin(request);
    if (!stored) return respond(stored.error());
    if (*stored) {
      auto response =
          route.replay ? route.replay(request, **stored) : Result<Response>(response_of(**stored));
      if (!response) return respond(response.error());
      return respond(std::move(response->with("Idempotency-Replayed", "true")));
    }
  }
  // `request` is still valid because handlers that store their response send it before they return.
  const Respond answer = remembered ? Respond([this, &request, respond](Response response) {
    answers_.end(request);
    respond(std::move(response));
  })
                                    : respond;
  answer_failures(request, answer, [&] { route.handler(request, answer); });
}

void Api::answer_failures(const Request& request, const Respond& answer,
                          const std::function<void()>& work) {
  try {
    work();
  } catch (const QuestionEnded& ended) {
    answer(ended.problem());
  } catch (const std::exception& error) {
    log::error("request " + std::string(name(request.method)) + " " + request.path_for_log() +
               " failed: " + error.what());
    answer(Error{ErrorCode::internal,
                 "Internal error",
                 "An internal error occurred. Ask an administrator to check the log of the server.",
                 {}});
  }
}

// Public routes get no tag here. The page has its own tags, and caches should not keep the health
// status.
void Api::answer_read(const Request& request, const Route& route, const Respond& respond) {
  if (!route.role) return route.handler(request, respond);
  const auto known = request.header("if-none-match");
  const auto state_now = [&]() -> std::optional<std::string> {
    const auto state = route.state ? route.state(request) : std::nullopt;
    return state ? std::optional(tag_of_state(request, *state)) : std::nullopt;
  };
  // Compares the tags first, to avoid unnecessary calls of the handler. A tag depends on `Accept`.
  // `*` matches any existing entity, so it can be compared only after the call.
  const auto before = state_now();
  if (before && known != "*" && names_tag(known, *before))
    return respond(std::move(empty_response(304).with("ETag", *before).with("Vary", "Accept")));
  const Respond with_tag([respond, known_tags = std::string(known), before,
                          state_now](Response response) {
    if (response.status != 200) return respond(std::move(response));
    // If the state is the same before and after the handler, the response shows exactly this state.
    if (before && response.header("ETag").empty() && state_now() == before) {
      if (response.header("Vary").empty()) response.with("Vary", "Accept");
      response.with("ETag", *before);
      return respond(names_tag(known_tags, *before) ? not_modified(response) : std::move(response));
    }
    const auto tag = tag_of_body(response);
    if (!tag) return respond(std::move(response));
    // The tag is for programs. `no-store` prevents a shared browser from keeping lists of users and
    // sessions.
    response.with("ETag", *tag).with("Cache-Control", "private, no-store");
    respond(names_tag(known_tags, *tag) ? not_modified(response) : std::move(response));
  });
  route.handler(request, with_tag);
}

bool Api::is_live_address(const Request& request) {
  const auto& s = request.segments;
  return s.size() == 5 && s[0] == "api" && s[1] == "v1" && s[2] == "models" && s[4] == "live";
}

Result<Api::LiveEntry> Api::admit_live(Request& request) {
  request.params["model"] = request.segments[3];
  STRATA_TRY(check_host(request, own_names_));
  STRATA_TRY(identify(request, live_));
  STRATA_TRY(check_upgrade_origin(request, options_.allowed_origins));
  bool is_follower = false;
  auto room = enter_room(request, is_follower);
  if (!room) return tl::unexpected(room.error());
  auto project = STRATA_TRY(store_.projects().find(to_string((*room)->model().project_id)));
  // Finds the name and color that other users see. If the account is deleted, the server closes the
  // connection later.
  auto person = store_.accounts().find(request.user());
  if (!person && person.error().code != ErrorCode::not_found) return tl::unexpected(person.error());
  std::optional<protocol::PersonalView> view;
  if (person && !request.principal->kiosk) {
    auto stored = personal_view(store_, person->name, request.role(), **room);
    if (!stored) return tl::unexpected(stored.error());
    auto parsed = STRATA_TRY(protocol::from_json<protocol::PersonalView>(*stored));
    view = std::move(parsed);
  }
  room::Portrait portrait = person ? portrait_of(*person) : room::Portrait();
  portrait.is_person = !request.principal->kiosk;
  return LiveEntry{std::move(*room),    project.slug,    *request.principal,
                   std::move(portrait), std::move(view), Authenticator::secret_of(request),
                   is_follower};
}

Result<std::shared_ptr<room::Room>> Api::enter_room(const Request& request, bool& is_follower) {
  const std::string& model = request.segments[3];
  const bool may_follow = rooms_.may_follow() && request.role() < Role::annotator;
  // If a follower is open, the caller joins it, even if the model has no owner at present.
  is_follower = may_follow && rooms_.is_followed(model);
  if (!is_follower) {
    auto owner = STRATA_TRY(rooms_.elsewhere(model));
    if (owner && !may_follow) return tl::unexpected(moved_to(std::move(*owner)));
    is_follower = owner.has_value();
  }
  return is_follower ? rooms_.follow(model, request.role()) : rooms_.open(model, request.role());
}

bool Api::is_still_welcome(const std::string& secret, ProjectId project_id, Role role) {
  return net::is_still_welcome(auth_, secret, project_id, role);
}

std::shared_ptr<LiveSession> Api::make_session(LiveEntry entry, std::weak_ptr<LiveSocket> socket) {
  if (entry.project_slug == jobs::kDemoProject && !entry.principal.kiosk && !entry.is_follower)
    demo_annotators_.visited(entry.room->model());
  auto session = std::make_shared<LiveSession>(
      shared_, std::move(entry.room), std::move(entry.project_slug), std::move(entry.principal),
      std::move(entry.portrait), std::move(entry.personal_view), socket);
  live_sockets().add(std::move(socket), session, std::move(entry.secret));
  return session;
}

}  // namespace strata::net
