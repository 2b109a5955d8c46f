#pragma once

#include <array>
#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/teardown.hpp>
#include <memory>
#include <tuple>
#include <utility>
#include <variant>

namespace strata::net {

// A completion handler with one type for every read and write. With different types, the compiler
// would compile the TLS code again for each HTTP and WebSocket operation. This took longer than all
// other units of the module.
class IoDone {
 public:
  template <class Handler>
  explicit IoDone(Handler handler) : held_(std::make_unique<HeldOf<Handler>>(std::move(handler))) {}
  void operator()(boost::beast::error_code error, std::size_t size = 0) { held_->run(error, size); }

 private:
  struct Held {
    virtual ~Held() = default;
    virtual void run(boost::beast::error_code error, std::size_t size) = 0;
  };
  template <class Handler>
  struct HeldOf final : Held {
    explicit HeldOf(Handler handler) : handler_(std::move(handler)) {}
    void run(boost::beast::error_code error, std::size_t size) override { handler_(error, size); }
    Handler handler_;
  };
  std::unique_ptr<Held> held_;
};

// The first non-empty buffers of a sequence, which are enough to read or write some bytes.
template <class Buffer>
class SomeBuffers {
 public:
  using value_type = Buffer;
  using const_iterator = const Buffer*;

  template <class Sequence>
  explicit SomeBuffers(const Sequence& sequence) {
    const auto end = boost::asio::buffer_sequence_end(sequence);
    for (auto at = boost::asio::buffer_sequence_begin(sequence);
         at != end && count_ < buffers_.size(); ++at)
      if (const Buffer buffer(*at); buffer.size() > 0) buffers_[count_++] = buffer;
  }
  const_iterator begin() const { return buffers_.data(); }
  const_iterator end() const { return buffers_.data() + count_; }

 private:
  std::array<Buffer, 16> buffers_{};
  std::size_t count_ = 0;
};

// A TCP connection with or without TLS, as an asynchronous stream. Move it only if no operation is
// pending.
class ConnectionStream {
 public:
  using next_layer_type = boost::beast::tcp_stream;
  using executor_type = next_layer_type::executor_type;

  explicit ConnectionStream(boost::asio::ip::tcp::socket socket);

  executor_type get_executor() noexcept { return next_layer().get_executor(); }
  next_layer_type& next_layer() noexcept;

  bool has_tls() const noexcept { return std::holds_alternative<Tls>(stream_); }
  // Starts TLS on the connection. `first` contains the bytes that were already read from the
  // client. Returns the number of these bytes that were used.
  boost::asio::awaitable<std::tuple<boost::beast::error_code, std::size_t>> start_tls(
      boost::asio::ssl::context& context, boost::asio::const_buffer first);
  // Sends close_notify to end TLS on the connection.
  boost::asio::awaitable<void> end_tls();

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::beast::error_code, std::size_t)>(
        [this](auto handler, const SomeBuffers<boost::asio::mutable_buffer>& into) {
          read_some(into, done(std::move(handler)));
        },
        token, SomeBuffers<boost::asio::mutable_buffer>(buffers));
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, void(boost::beast::error_code, std::size_t)>(
        [this](auto handler, const SomeBuffers<boost::asio::const_buffer>& from) {
          write_some(from, done(std::move(handler)));
        },
        token, SomeBuffers<boost::asio::const_buffer>(buffers));
  }

  // Beast calls it to close the connection below a WebSocket.
  template <class Handler>
  friend void async_teardown(boost::beast::role_type role, ConnectionStream& connection,
                             Handler&& handler) {
    const boost::asio::any_io_executor executor =
        boost::asio::get_associated_executor(handler, connection.get_executor());
    auto ended = [handler = std::forward<Handler>(handler)](
                     boost::beast::error_code error, std::size_t) mutable { handler(error); };
    connection.tear_down(role, boost::asio::bind_executor(executor, IoDone(std::move(ended))));
  }

 private:
  using Tls = boost::beast::ssl_stream<next_layer_type>;
  using Done = boost::asio::executor_binder<IoDone, boost::asio::any_io_executor>;

  template <class Handler>
  Done done(Handler handler) {
    const boost::asio::any_io_executor executor =
        boost::asio::get_associated_executor(handler, get_executor());
    return boost::asio::bind_executor(executor, IoDone(std::move(handler)));
  }
  void read_some(const SomeBuffers<boost::asio::mutable_buffer>& into, Done done);
  void write_some(const SomeBuffers<boost::asio::const_buffer>& from, Done done);
  void tear_down(boost::beast::role_type role, Done done);

  std::variant<next_layer_type, Tls> stream_;
};

}  // namespace strata::net
