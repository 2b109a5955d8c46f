#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <memory>

#include "net/api/api.h"

namespace strata::net {

// The state that all connections of one server share. A pending response locks `io`, and is dropped
// if the server has stopped. Connections hold only a weak pointer because `io` owns their coroutine
// frames.
struct Connections {
  std::weak_ptr<boost::asio::io_context> io;
  Api& api;
  std::atomic<int> requests_at_work{0};
  std::atomic<int> streams_at_work{0};
  std::atomic<int> event_streams{0};
  std::atomic<bool> stopping{false};
};

// Serves one TCP connection until it ends or becomes a WebSocket. The executor of the socket must
// be a separate strand. `tls` is null for plain HTTP.
void start_http_session(boost::asio::ip::tcp::socket socket,
                        std::shared_ptr<Connections> connections,
                        std::shared_ptr<boost::asio::ssl::context> tls);

}  // namespace strata::net
