#include "net/transport/connection_stream.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace strata::net {
namespace asio = boost::asio;
namespace beast = boost::beast;

namespace {
constexpr auto kUseResult = asio::as_tuple(asio::use_awaitable);
}

ConnectionStream::ConnectionStream(asio::ip::tcp::socket socket)
    : stream_(next_layer_type(std::move(socket))) {}

ConnectionStream::next_layer_type& ConnectionStream::next_layer() noexcept {
  if (auto* tls = std::get_if<Tls>(&stream_)) return tls->next_layer();
  return *std::get_if<next_layer_type>(&stream_);
}

asio::awaitable<std::tuple<beast::error_code, std::size_t>> ConnectionStream::start_tls(
    asio::ssl::context& context, asio::const_buffer first) {
  next_layer_type plain = std::move(next_layer());
  Tls& tls = stream_.emplace<Tls>(std::move(plain), context);
  auto result = co_await tls.async_handshake(asio::ssl::stream_base::server, first, kUseResult);
  co_return result;
}

asio::awaitable<void> ConnectionStream::end_tls() {
  Tls& tls = std::get<Tls>(stream_);
  auto [error] = co_await tls.async_shutdown(kUseResult);
  (void)error;  // the client may have disconnected already
}

void ConnectionStream::read_some(const SomeBuffers<asio::mutable_buffer>& into, Done done) {
  std::visit([&](auto& stream) { stream.async_read_some(into, std::move(done)); }, stream_);
}

void ConnectionStream::write_some(const SomeBuffers<asio::const_buffer>& from, Done done) {
  std::visit([&](auto& stream) { stream.async_write_some(from, std::move(done)); }, stream_);
}

void ConnectionStream::tear_down(beast::role_type role, Done done) {
  using beast::websocket::async_teardown;
  std::visit([&](auto& stream) { async_teardown(role, stream, std::move(done)); }, stream_);
}

}  // namespace strata::net
