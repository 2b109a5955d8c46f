#pragma once

#include <boost/asio/async_result.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <chrono>
#include <utility>
#include <variant>

namespace strata::net {

// A TCP connection, with TLS or without: an asynchronous stream whose users need not know which. Moved only while nothing is under way.
class ConnectionStream {
 public:
  using next_layer_type = boost::beast::tcp_stream;
  using executor_type = next_layer_type::executor_type;

  explicit ConnectionStream(boost::asio::ip::tcp::socket socket) : stream_(next_layer_type(std::move(socket))) {}

  executor_type get_executor() noexcept { return next_layer().get_executor(); }
  next_layer_type& next_layer() noexcept {
    if (auto* tls = std::get_if<Tls>(&stream_)) return tls->next_layer();
    return *std::get_if<next_layer_type>(&stream_);
  }

  bool has_tls() const noexcept { return std::holds_alternative<Tls>(stream_); }
  // From here on the connection speaks TLS. `first`: bytes of the client that were read already; completes with how many of them were used.
  template <class Buffers, class Token>
  auto async_start_tls(boost::asio::ssl::context& context, const Buffers& first, Token&& token) {
    next_layer_type plain = std::move(next_layer());
    return stream_.emplace<Tls>(std::move(plain), context)
        .async_handshake(boost::asio::ssl::stream_base::server, first, std::forward<Token>(token));
  }
  // Tells the client that this was all; of a connection with TLS.
  template <class Token>
  auto async_end_tls(Token&& token) {
    return std::get<Tls>(stream_).async_shutdown(std::forward<Token>(token));
  }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::beast::error_code, std::size_t)>(
        [this](auto handler, const Buffers& into) {
          std::visit([&](auto& stream) { stream.async_read_some(into, std::move(handler)); }, stream_);
        },
        token, buffers);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::beast::error_code, std::size_t)>(
        [this](auto handler, const Buffers& from) {
          std::visit([&](auto& stream) { stream.async_write_some(from, std::move(handler)); }, stream_);
        },
        token, buffers);
  }

  // How a WebSocket ends the connection below it; found by Beast.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ConnectionStream& connection, Handler&& handler) {
    using boost::beast::websocket::async_teardown;
    std::visit([&](auto& stream) { async_teardown(role, stream, std::forward<Handler>(handler)); }, connection.stream_);
  }

 private:
  using Tls = boost::beast::ssl_stream<next_layer_type>;
  std::variant<next_layer_type, Tls> stream_;
};

}  // namespace strata::net
