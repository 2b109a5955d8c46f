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

// The sockets of the server, for HTTP, the live connections and the page. The arguments must
// outlive the object.
class Server {
 public:
  // The server accepts connections when the call returns. Returns an error with advice for an
  // address in use, a short owner token, an invalid certificate, or an upload folder without write
  // permission.
  static Result<std::unique_ptr<Server>> start(ServerOptions options, store::Store& store,
                                               room::Rooms& rooms, jobs::JobQueue& jobs,
                                               render::Renderer& renderer);
  ~Server();

  std::uint16_t port() const;
  // Stops accepting connections, closes live connections, finishes the running requests and joins
  // the threads. The owner of the rooms must drain them afterwards. Idempotent.
  void stop();

 private:
  Server();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace strata::net
