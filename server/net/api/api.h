#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/demo/demo_annotators.h"
#include "app/layers/recomputer.h"
#include "app/strokes/brush_shape_cache.h"
#include "app/template_registry.h"
#include "app/trash_purger.h"
#include "core/ids.h"
#include "domain/people/role.h"
#include "jobs/job_queue.h"
#include "net/api/metrics.h"
#include "net/api/route_context.h"
#include "net/auth/auth.h"
#include "net/http/edit_idempotency.h"
#include "net/http/idempotency_store.h"
#include "net/http/question_desk.h"
#include "net/http/router.h"
#include "net/http/static_files.h"
#include "net/http/worker_pool.h"
#include "net/live/live_session.h"
#include "net/live/live_sockets.h"
#include "net/live/table_events.h"
#include "net/transport/server_options.h"
#include "protocol/messages.h"
#include "render/renderer.h"
#include "room/participants.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/store.h"

namespace strata::net {

// The layer between the sockets and the rooms: finds the route, authenticates and authorizes the
// caller, and recognizes repeated requests. Does not depend on a socket library.
class Api {
 public:
  Api(ServerOptions options, store::Store& store, room::Rooms& rooms, jobs::JobQueue& jobs,
      render::Renderer& renderer, app::TemplateRegistry templates);
  ~Api();

  const ServerOptions& options() const { return options_; }
  Metrics& metrics() { return *shared_->metrics; }
  WorkerPool& workers() { return workers_; }
  QuestionDesk& questions() { return questions_; }

  // Call once the head of the request is read; does not block. Writes the path's parameters into
  // the request. Null: `refusal` is the answer.
  const Route* find_route(Request& request, Response& refusal) const;
  // Call on a worker before the body is read. Returns the refusal, if any.
  std::optional<Response> admit(Request& request, const Route& route);
  // Call on a worker once the body is read. That may have taken long, and in the meantime the
  // caller may have lost the access or the role.
  std::optional<Response> admit_again(Request& request, const Route& route);
  // Call on a worker, with the body.
  void handle(const Request& request, const Route& route, const Respond& respond);

  // For the live connection of a model: whether the address is one, and whether the caller may
  // connect (blocks: opens the room).
  static bool is_live_address(const Request& request);
  struct LiveEntry {
    std::shared_ptr<room::Room> room;
    std::string project_slug;
    Principal principal;
    room::Portrait portrait;
    std::optional<protocol::PersonalView> personal_view;  // a kiosk has none
    std::string secret;                                   // as the client sent it
  };
  Result<LiveEntry> admit_live(Request& request);
  std::shared_ptr<LiveSession> make_session(LiveEntry entry, std::weak_ptr<LiveSocket> socket);
  // Whether a session with this secret may stay in the project in this role (blocks). While the
  // database is unreachable, every session may stay.
  bool is_still_welcome(const std::string& secret, ProjectId project_id, Role role);
  LiveSockets& live_sockets() { return *shared_->sockets; }

  void stop_workers();

 private:
  void answer_read(const Request& request, const Route& route, const Respond& respond);
  static void answer_failures(const Request& request, const Respond& answer,
                              const std::function<void()>& work);
  // Authenticates the caller and checks the role that the route requires.
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
  Router router_;
  Route page_;  // every address outside the API
  Route live_;  // the live connections, without a handler
  app::TrashPurger trash_purger_;
  const TableEvents table_events_;
  const RouteContext context_;
  app::Recomputer recomputer_;
  app::DemoAnnotators demo_annotators_;
};

// The headers of every answer.
const Headers& security_headers();

}  // namespace strata::net
