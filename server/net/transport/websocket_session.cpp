#include "net/transport/websocket_session.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>

#include "core/log.h"
#include "net/live/close_codes.h"
#include "net/transport/on_worker.h"

namespace strata::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using std::chrono::seconds;

constexpr auto kUseResult = asio::as_tuple(asio::use_awaitable);
constexpr seconds kHandshake{10};
constexpr seconds kClosing{5};
// Above this size, the connection is closed. Above the smaller limit of the protocol, the server
// refuses the message with a problem.
constexpr std::size_t kMaxMessage = 4u << 20;
constexpr std::size_t kMaxQueuedTexts = 4096;
constexpr std::size_t kMaxQueuedBytes = 16u << 20;
// The limits for frames that the client has not acknowledged: 3 frames of 16 rectangles for each of
// 4 views, or whole frames of the largest size.
constexpr std::size_t kMaxQueuedFrames = 256;
constexpr std::size_t kMaxQueuedFrameBytes = 64u << 20;

class WebSocketSession final : public LiveSocket,
                               public std::enable_shared_from_this<WebSocketSession> {
 public:
  WebSocketSession(ConnectionStream stream, std::shared_ptr<Connections> connections)
      : ws_(std::move(stream)),
        connections_(std::move(connections)),
        stall_timer_(ws_.get_executor()),
        close_timer_(ws_.get_executor()),
        recheck_timer_(ws_.get_executor()) {
    ++connections_->api.metrics().open_sockets;
  }

  asio::awaitable<void> run(http::request<http::empty_body> request, Api::LiveEntry entry) {
    auto self = shared_from_this();  // the coroutine frame keeps the session alive
    prepare();
    auto [accept_error] = co_await ws_.async_accept(request, kUseResult);
    if (!accept_error) {
      const auto watch = [self, secret = entry.secret, project_id = entry.room->model().project_id,
                          role = entry.principal.role] {
        return self->watch_sign_in(secret, project_id, role);
      };
      live_ = connections_->api.make_session(std::move(entry), weak_from_this());
      asio::co_spawn(ws_.get_executor(), watch, asio::detached);
      co_await read();
      live_->on_closed();
    }
    over_ = true;
    recheck_timer_.cancel();
    stall_timer_.cancel();
    close_timer_.cancel();
    --connections_->api.metrics().open_sockets;
  }

  // Accepts the connection only to send the address of the model's node, because browsers do not
  // follow the redirection of a WebSocket.
  asio::awaitable<void> run_moved(http::request<http::empty_body> request, std::string url) {
    auto self = shared_from_this();  // the coroutine frame keeps the session alive
    prepare();
    auto [accept_error] = co_await ws_.async_accept(request, kUseResult);
    if (!accept_error) {
      queue_text(moved_message(url));
      start_close(kCloseMoved, "another node has the model");
      co_await read();
    }
    over_ = true;
    stall_timer_.cancel();
    close_timer_.cancel();
    --connections_->api.metrics().open_sockets;
  }

  // --- LiveSocket, called from any thread
  void send_text(std::string text) override {
    asio::post(ws_.get_executor(), [self = shared_from_this(), text = std::move(text)]() mutable {
      self->queue_text(std::move(text));
    });
  }
  void send_frame(stream::FrameBytes frame) override {
    asio::post(ws_.get_executor(), [self = shared_from_this(), frame = std::move(frame)]() mutable {
      self->queue_frame(std::move(frame));
    });
  }
  void close(int code, std::string reason) override {
    asio::post(ws_.get_executor(), [self = shared_from_this(), code, reason = std::move(reason)] {
      self->start_close(code, reason);
    });
  }
  void run_after(std::chrono::milliseconds delay, std::function<void()> work) override {
    auto timer = std::make_shared<asio::steady_timer>(ws_.get_executor(), delay);
    timer->async_wait(
        [self = shared_from_this(), timer, work = std::move(work)](beast::error_code error) {
          if (!error && !self->over_) work();
        });
  }

 private:
  const Timeouts& timeouts() const { return connections_->api.options().timeouts; }

  void prepare() {
    websocket::stream_base::timeout timeout;
    timeout.handshake_timeout = kHandshake;
    timeout.idle_timeout = timeouts().idle;
    timeout.keep_alive_pings = true;
    ws_.set_option(timeout);
    ws_.set_option(websocket::stream_base::decorator([](websocket::response_type& response) {
      response.set(http::field::sec_websocket_protocol, "strata.v1");
      response.set(http::field::server, "strata");
    }));
    ws_.read_message_max(kMaxMessage);
    ws_.write_buffer_bytes(64 * 1024);
    ws_.auto_fragment(false);
  }

  asio::awaitable<void> read() {
    beast::flat_buffer buffer;
    for (;;) {
      auto [error, size] = co_await ws_.async_read(buffer, kUseResult);
      if (error) co_return;
      if (closing_) {
        // Continues to read until the client also closes the connection.
      } else if (!ws_.got_text()) {
        live_->on_binary();
      } else if (auto work = live_->on_text(beast::buffers_to_string(buffer.data()))) {
        const Work run_it = [work](const Respond& respond) {
          work();
          respond(empty_response(200));
        };
        const Response done = co_await on_worker(connections_, ws_.get_executor(), run_it);
        if (done.status != 200) start_close(kCloseTryAgain, "server too busy");
      }
      buffer.consume(buffer.size());
    }
  }

  // Ends the connection when the session ends. The session or token may expire, and another server
  // may revoke it.
  asio::awaitable<void> watch_sign_in(std::string secret, ProjectId project_id, Role role) {
    auto self = shared_from_this();
    // Checks immediately because accounts may have changed while the model was opened.
    while (!over_ && !closing_) {
      const Work ask = [&api = connections_->api, secret, project_id,
                        role](const Respond& respond) {
        respond(empty_response(api.is_still_welcome(secret, project_id, role) ? 200 : 401));
      };
      const Response answer = co_await on_worker(connections_, ws_.get_executor(), ask);
      if (answer.status == 401) start_close(kClosePolicy, "signed out");
      recheck_timer_.expires_after(timeouts().recheck);
      auto [error] = co_await recheck_timer_.async_wait(kUseResult);
      if (error) co_return;
    }
  }

  void queue_text(std::string text) {
    if (closing_ || over_) return;
    queued_bytes_ += text.size();
    texts_.push_back(std::move(text));
    if (texts_.size() > kMaxQueuedTexts || queued_bytes_ > kMaxQueuedBytes)
      return start_close(kCloseTryAgain, "reading too slowly");
    write_next();
  }

  void queue_frame(stream::FrameBytes frame) {
    if (closing_ || over_) return;
    queued_frame_bytes_ += frame->size();
    frames_.push_back(std::move(frame));
    if (frames_.size() > kMaxQueuedFrames || queued_frame_bytes_ > kMaxQueuedFrameBytes)
      return start_close(kCloseTryAgain, "reading too slowly");
    write_next();
  }

  // Control messages have priority over frames.
  void write_next() {
    if (writing_ || over_) return;
    if (closing_ && texts_.empty()) return do_close();
    if (!texts_.empty()) {
      text_ = std::move(texts_.front());
      texts_.pop_front();
      queued_bytes_ -= text_.size();
      ws_.text(true);
      write(asio::buffer(text_));
    } else if (!frames_.empty()) {
      frame_ = std::move(frames_.front());
      frames_.pop_front();
      queued_frame_bytes_ -= frame_->size();
      ws_.binary(true);
      write(asio::buffer(*frame_));
    }
  }

  void write(asio::const_buffer bytes) {
    writing_ = true;
    stall_timer_.expires_after(timeouts().stall);
    stall_timer_.async_wait([weak = weak_from_this()](beast::error_code error) {
      auto self = weak.lock();
      if (!error && self && self->writing_) self->drop();
    });
    ws_.async_write(bytes, [self = shared_from_this()](beast::error_code error, std::size_t) {
      self->writing_ = false;
      self->stall_timer_.cancel();
      self->frame_.reset();
      if (error) return self->drop();
      self->write_next();
    });
  }

  void start_close(int code, const std::string& reason) {
    if (closing_ || over_) return;
    closing_ = true;
    reason_ = websocket::close_reason(static_cast<websocket::close_code>(code),
                                      beast::string_view(reason));
    // With these codes, keeps the queued messages because they contain the reason. For example, the
    // model was deleted, or an edit was saved before the server stopped.
    if (code != kCloseGoingAway && code != kCloseMoved) texts_.clear();
    frames_.clear();
    close_timer_.expires_after(kClosing);
    close_timer_.async_wait([weak = weak_from_this()](beast::error_code error) {
      auto self = weak.lock();
      if (!error && self) self->drop();
    });
    write_next();
  }

  void do_close() {
    if (std::exchange(close_sent_, true)) return;
    ws_.async_close(reason_, [self = shared_from_this()](beast::error_code) {});
  }

  // The reading coroutine detects the closed connection and ends the session.
  void drop() { beast::get_lowest_layer(ws_).close(); }

  websocket::stream<ConnectionStream> ws_;
  const std::shared_ptr<Connections> connections_;
  std::shared_ptr<LiveSession> live_;
  asio::steady_timer stall_timer_, close_timer_, recheck_timer_;
  std::deque<std::string> texts_;
  std::deque<stream::FrameBytes> frames_;
  std::size_t queued_bytes_ = 0, queued_frame_bytes_ = 0;
  std::string text_;          // being sent
  stream::FrameBytes frame_;  // being sent
  bool writing_ = false, closing_ = false, close_sent_ = false, over_ = false;
  websocket::close_reason reason_;
};

// Runs a new session. `run` returns the coroutine of the session.
template <class Run>
void start(ConnectionStream stream, std::shared_ptr<Connections> connections, Run run) {
  auto executor = stream.get_executor();
  auto session = std::make_shared<WebSocketSession>(std::move(stream), std::move(connections));
  asio::co_spawn(
      executor, [session, run = std::move(run)]() mutable { return run(*session); },
      [](const std::exception_ptr& failure) {
        if (!failure) return;
        try {
          std::rethrow_exception(failure);
        } catch (const std::exception& error) {
          log::error(std::string("a live connection failed: ") + error.what());
        }
      });
}

}  // namespace

void start_websocket(ConnectionStream stream, http::request<http::empty_body> request,
                     std::shared_ptr<Connections> connections, Api::LiveEntry entry) {
  start(
      std::move(stream), std::move(connections),
      [request = std::move(request), entry = std::move(entry)](WebSocketSession& session) mutable {
        return session.run(std::move(request), std::move(entry));
      });
}

void start_moved_websocket(ConnectionStream stream, http::request<http::empty_body> request,
                           std::shared_ptr<Connections> connections, std::string url) {
  start(std::move(stream), std::move(connections),
        [request = std::move(request), url = std::move(url)](WebSocketSession& session) mutable {
          return session.run_moved(std::move(request), std::move(url));
        });
}

}  // namespace strata::net
