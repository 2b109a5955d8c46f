#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>

#include "domain/people/question.h"

namespace strata::net {

// While the server works on a client's question, checks the socket a few times a second, and ends
// the question when the client is gone. Asks the operating system and reads nothing, so TLS and
// pipelined requests do not matter. A client that only shuts down its sending side counts as gone.
// Belongs to the connection's strand.
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

// Whether the other end has closed the connection, or the connection broke.
bool has_gone(int socket);

}  // namespace strata::net
