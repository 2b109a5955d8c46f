#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>

#include "domain/people/question.h"

namespace strata::net {

// SurfaceImages a few times a second whether the client of a connection is still there while its
// question is worked on, and ends the question when it is not. It asks the system and reads
// nothing, so it does not matter whether the connection speaks TLS, or has sent its next request
// already. A client that closes its sending side alone counts as gone. Belongs to the connection's
// strand.
class ClientWatch {
 public:
  // `socket`: of a connection that stays open as long as the watch.
  ClientWatch(const boost::asio::any_io_executor& executor, int socket,
              std::shared_ptr<Question> question, std::function<void()> on_gone);
  ~ClientWatch();
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;

 private:
  struct Watched;
  const std::shared_ptr<Watched> watched_;
};

// Whether the other end has closed the connection, or it broke.
bool has_gone(int socket);

}  // namespace strata::net
