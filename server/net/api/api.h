#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/demo/demo_annotators.h"
#include "app/journal_upkeep.h"
#include "app/layers/recomputer.h"
#include "app/nodes/node_listener.h"
#include "app/strokes/brush_shape_cache.h"
#include "app/template_registry.h"
#include "app/trash_purger.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "jobs/job_queue.h"
#include "net/api/metrics.h"
#include "net/api/route_context.h"
#include "net/auth/auth.h"
#include "net/auth/sign_on_desk.h"
#include "net/http/edit_idempotency.h"
#include "net/http/idempotency_store.h"
#include "net/http/question_desk.h"
#include "net/http/router.h"
#include "net/http/static_files.h"
#include "net/http/worker_pool.h"
#include "net/live/live_session.h"
#include "net/live/live_sockets.h"
#include "net/live/node_events.h"
#include "net/live/table_events.h"
#include "net/transport/server_options.h"
#include "protocol/messages.h"
#include "render/renderer.h"
#include "room/participants.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/store.h"

namespace strata::net {

// The part of the server between the sockets and the rooms. Finds the route, authenticates and
// authorizes the caller, and detects repeated requests. Does not depend on a socket library.
class Api {
 public:
  Api(ServerOptions options, store::Store& store, room::Rooms& rooms, jobs::JobQueue& jobs,
      render::Renderer& renderer, app::TemplateRegistry templates);
  ~Api();

  const ServerOptions& options() const { return options_; }
  Metrics& metrics() { return *shared_->metrics; }
  WorkerPool& workers() { return workers_; }
  QuestionDesk& questions() { return questions_; }

  // Finds the route when the head of the request has been read. Does not block. Writes the
  // parameters of the path to the request. If it returns null, `refusal` is the response.
  const Route* find_route(Request& request, Response& refusal) const;
  // Checks the request before the body is read. Call it on a worker. Returns the response if the
  // request is refused.
  std::optional<Response> admit(Request& request, const Route& route);
  // Checks the request again after the body has been read, because the caller may have lost the
  // access or the role in the meantime. Call it on a worker.
  std::optional<Response> admit_again(Request& request, const Route& route);
  // Handles the request, which includes the body. Call it on a worker.
  void handle(const Request& request, const Route& route, const Respond& respond);

  // For the live connection of a model: return whether the address is the address of a live
  // connection, and whether the caller may connect. The second function opens the room and may
  // block.
  static bool is_live_address(const Request& request);
  struct LiveEntry {
    std::shared_ptr<room::Room> room;
    std::string project_slug;
    Principal principal;
    room::Portrait portrait;
    std::optional<protocol::PersonalView> personal_view;  // empty for a kiosk
    std::string secret;                                   // as the client sent it
    bool is_follower = false;                             // another node has the model
  };
  Result<LiveEntry> admit_live(Request& request);
  std::shared_ptr<LiveSession> make_session(LiveEntry entry, std::weak_ptr<LiveSocket> socket);
  // Returns whether a session with this secret may stay in the project with this role. Returns true
  // while the database is unreachable. Blocks.
  bool is_still_welcome(const std::string& secret, ProjectId project_id, Role role);
  LiveSockets& live_sockets() { return *shared_->sockets; }

  void stop_workers();

 private:
  std::unique_ptr<app::NodeListener> listen_to_nodes();
  void answer_read(const Request& request, const Route& route, const Respond& respond);
  // Opens the room of a live connection, or one that follows the owner, for a caller who can only
  // look. Returns `moved` if another node has the model and the caller can edit.
  Result<std::shared_ptr<room::Room>> enter_room(const Request& request, bool& is_follower);
  static void answer_failures(const Request& request, const Respond& answer,
                              const std::function<void()>& work);
  // Authenticates the caller and checks the role that the route requires. Returns `unavailable` for
  // a model while this node has no lease.
  Result<void> identify(Request& request, const Route& route);

  const ServerOptions options_;
  const std::vector<std::string> own_names_;
  store::Store& store_;
  room::Rooms& rooms_;
  Authenticator auth_;
  IdempotencyStore answers_;
  EditIdempotency edit_book_;
  StaticFiles files_;
  const std::shared_ptr<app::BrushShapeCache> tools_;
  const app::TemplateRegistry templates_;
  std::shared_ptr<LiveShared> shared_;
  WorkerPool workers_;
  QuestionDesk questions_;
  SignOnDesk sign_ons_;
  Router router_;
  Route page_;  // for all addresses outside the API
  Route live_;  // for the live connections; has no handler
  app::TrashPurger trash_purger_;
  app::JournalUpkeep journal_upkeep_;
  const TableEvents table_events_;
  const RouteContext context_;
  app::Recomputer recomputer_;
  app::DemoAnnotators demo_annotators_;
  NodeEvents node_events_;
  std::unique_ptr<app::NodeListener> node_listener_;  // null: a site with one server
};

// Returns the headers that every response gets.
const Headers& security_headers();

}  // namespace strata::net
