#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <memory>

#include "net/api/api.h"

namespace strata::net {

// What every connection of one server shares. Answers under way hold `io`, so that one which comes
// after the server has stopped finds a place to end; connections do not, since their frames live in
// it.
struct Connections {
  std::weak_ptr<boost::asio::io_context> io;
  Api& api;
  std::atomic<int> requests_at_work{0};
  std::atomic<int> streams_at_work{0};
  std::atomic<int> event_streams{0};
  std::atomic<bool> stopping{false};
};

// Serves one TCP connection until it ends or becomes a WebSocket. The socket's executor is a strand
// of its own. `tls`: the connection speaks it; nothing: it does not.
void start_http_session(boost::asio::ip::tcp::socket socket,
                        std::shared_ptr<Connections> connections,
                        std::shared_ptr<boost::asio::ssl::context> tls);

}  // namespace strata::net
