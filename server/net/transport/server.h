#pragma once

#include <cstdint>
#include <memory>

#include "core/error.h"
#include "jobs/job_queue.h"
#include "net/transport/server_options.h"
#include "render/renderer.h"
#include "room/room.h"
#include "room/rooms.h"
#include "store/store.h"

namespace strata::net {

// The server's sockets: HTTP, the live connections and the page. What it is given must outlive it.
class Server {
 public:
  // Listens when it returns. Refused with advice: an address in use, a short owner token, a
  // certificate that cannot be used, an upload folder that cannot be written.
  static Result<std::unique_ptr<Server>> start(ServerOptions options, store::Store& store,
                                               room::Rooms& rooms, jobs::JobQueue& jobs,
                                               render::Renderer& renderer);
  ~Server();

  std::uint16_t port() const;
  // Takes no more connections, tells the live ones to come back later, answers what is at work, and
  // joins. Rooms are drained by their owner afterwards. Idempotent.
  void stop();

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::net
