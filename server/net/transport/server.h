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

// The server's sockets: HTTP, the live connections and the page. The arguments must outlive it.
class Server {
 public:
  // Listens when it returns. Refuses with advice: an address in use, a short owner token, an
  // invalid certificate, an upload folder without write permission.
  static Result<std::unique_ptr<Server>> start(ServerOptions options, store::Store& store,
                                               room::Rooms& rooms, jobs::JobQueue& jobs,
                                               render::Renderer& renderer);
  ~Server();

  std::uint16_t port() const;
  // Accepts no more connections, asks live clients to reconnect later, finishes running requests,
  // and joins. The owner of the rooms drains them afterwards. Idempotent.
  void stop();

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::net
