#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <memory>

#include "net/transport/connection_stream.h"
#include "net/transport/http_session.h"

namespace strata::net {

// Takes over a connection whose upgrade request was accepted. Serves it until it closes.
void start_websocket(ConnectionStream stream,
                     boost::beast::http::request<boost::beast::http::empty_body> request,
                     std::shared_ptr<Connections> connections, Api::LiveEntry entry);

}  // namespace strata::net
