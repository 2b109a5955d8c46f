#pragma once

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>

#include "domain/people/question.h"

namespace strata::net {

// Checks the socket a few times a second while the server computes the response to a client's
// request (`Question`). Ends the question when the client has disconnected. Queries the operating
// system without reading from the socket, so it supports TLS and pipelined requests. Also ends the
// question if a client shuts down only its sending side. Use it on the connection's strand.
class ClientWatch {
 public:
  // `socket` belongs to a connection that must stay open during the lifetime of this object.
  ClientWatch(const boost::asio::any_io_executor& executor, int socket,
              std::shared_ptr<Question> question, std::function<void()> on_gone);
  ~ClientWatch();
  ClientWatch(const ClientWatch&) = delete;
  ClientWatch& operator=(const ClientWatch&) = delete;

 private:
  struct Watched;
  const std::shared_ptr<Watched> watched_;
};

// Returns whether the other end has closed the connection or the connection is broken.
bool has_gone(int socket);

}  // namespace strata::net
