#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <memory>
#include <string>

#include "net/transport/connection_stream.h"
#include "net/transport/http_session.h"

namespace strata::net {

// Takes over a connection whose upgrade request was accepted. Serves it until it closes.
void start_websocket(ConnectionStream stream,
                     boost::beast::http::request<boost::beast::http::empty_body> request,
                     std::shared_ptr<Connections> connections, Api::LiveEntry entry);

// Takes over a connection for a model that another node has. Sends the message `moved` with the
// address of that node, and closes.
void start_moved_websocket(ConnectionStream stream,
                           boost::beast::http::request<boost::beast::http::empty_body> request,
                           std::shared_ptr<Connections> connections, std::string url);

}  // namespace strata::net
