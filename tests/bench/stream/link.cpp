#include "bench/stream/link.h"

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/experimental/channel.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <cmath>
#include <regex>
#include <vector>

namespace strata::bench {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;

constexpr auto kUseResult = asio::as_tuple(asio::use_awaitable);

// Limits the buffers of the socket, so the kernel does not queue megabytes in addition to the
// line's own queue.
void keep_short(tcp::socket& socket) {
  error_code ignored;
  socket.set_option(asio::socket_base::receive_buffer_size(int(Link::kQueueBytes)), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(int(Link::kQueueBytes)), ignored);
}

Clock::duration time_of(std::size_t bytes, double bits_per_second) {
  return std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(8.0 * double(bytes) / bits_per_second));
}

// Returns the number of bytes in transit at the full rate.
std::size_t bytes_under_way(const LinkQuality& quality) {
  return std::size_t(quality.bits_per_second / 8 *
                     std::chrono::duration<double>(quality.round_trip).count() / 2);
}

}  // namespace

std::optional<LinkQuality> parse_link(const std::string& text) {
  if (text == "loopback") return LinkQuality{};
  static const std::regex form(R"(([0-9]{1,4})ms/([0-9]{1,5}(?:\.[0-9]{1,3})?)Mbit)");
  std::smatch parts;
  if (!std::regex_match(text, parts, form)) return std::nullopt;
  const LinkQuality quality{text, std::chrono::milliseconds(std::stoi(parts[1])),
                            std::stod(parts[2]) * 1e6};
  if (quality.bits_per_second <= 0) return std::nullopt;
  return quality;
}

struct Link::State {
  State(asio::io_context& context, LinkQuality link_quality, tcp::endpoint to)
      : quality(std::move(link_quality)),
        server(to),
        acceptor(context, {asio::ip::address_v4::loopback(), 0}) {}
  const LinkQuality quality;
  const tcp::endpoint server;
  tcp::acceptor acceptor;
  std::vector<std::weak_ptr<Line>> lines;
  std::uint64_t bytes_taken = 0;
  int full_ways = 0;
};

// One connection with two directions, each from one socket to the other.
class Link::Line : public std::enable_shared_from_this<Link::Line> {
 public:
  Line(std::shared_ptr<State> state, tcp::socket viewer)
      : state_(std::move(state)),
        viewer_(std::move(viewer)),
        server_(viewer_.get_executor()),
        up_(viewer_, server_, *state_),
        down_(server_, viewer_, *state_) {
    keep_short(viewer_);
  }

  asio::awaitable<void> run() {
    auto self = shared_from_this();
    server_.open(tcp::v4());
    keep_short(server_);  // must precede the negotiation of the TCP window
    auto [error] = co_await server_.async_connect(state_->server, kUseResult);
    if (error) co_return close();
    error_code ignored;
    viewer_.set_option(tcp::no_delay(true), ignored);
    server_.set_option(tcp::no_delay(true), ignored);
    for (Way* way : {&up_, &down_}) {
      asio::co_spawn(viewer_.get_executor(), take(self, *way), asio::detached);
      asio::co_spawn(viewer_.get_executor(), give(self, *way), asio::detached);
    }
  }

  void close() {
    error_code ignored;
    viewer_.close(ignored);
    server_.close(ignored);
    for (Way* way : {&up_, &down_}) {
      way->pieces.close();
      way->pieces.cancel();
      way->arrival.cancel();
    }
  }

 private:
  // A piece without bytes marks the end of the sender's data.
  struct Piece {
    std::vector<char> bytes;
    Clock::time_point arrives;
  };
  struct Way {
    Way(tcp::socket& source, tcp::socket& sink, const State& state)
        : from(source),
          to(sink),
          pieces(source.get_executor(),
                 (kQueueBytes + bytes_under_way(state.quality)) / kPieceBytes),
          arrival(source.get_executor()) {}
    tcp::socket &from, &to;
    asio::experimental::channel<void(error_code, Piece)> pieces;
    asio::steady_timer arrival;
  };

  static asio::awaitable<void> take(std::shared_ptr<Line> line, Way& way) {
    const LinkQuality& quality = line->state_->quality;
    // The time at which the last bit of the previous piece leaves the sender.
    Clock::time_point sent_at = Clock::now();
    for (bool over = false; !over;) {
      Piece piece{std::vector<char>(kPieceBytes), {}};
      auto [error, size] = co_await way.from.async_read_some(asio::buffer(piece.bytes), kUseResult);
      over = bool(error);
      piece.bytes.resize(size);
      line->state_->bytes_taken += size;
      sent_at = std::max(sent_at, Clock::now()) + time_of(size, quality.bits_per_second);
      piece.arrives = sent_at + quality.round_trip / 2;
      if (way.pieces.try_send(error_code(), piece)) continue;
      ++line->state_->full_ways;
      auto [closed] = co_await way.pieces.async_send(error_code(), std::move(piece), kUseResult);
      --line->state_->full_ways;
      if (closed) co_return;
    }
  }

  static asio::awaitable<void> give(std::shared_ptr<Line> line, Way& way) {
    for (;;) {
      auto [closed, piece] = co_await way.pieces.async_receive(kUseResult);
      if (closed) co_return;
      way.arrival.expires_at(piece.arrives);
      auto [cancelled] = co_await way.arrival.async_wait(kUseResult);
      if (cancelled) co_return;
      if (piece.bytes.empty()) break;
      auto [error, size] =
          co_await asio::async_write(way.to, asio::buffer(piece.bytes), kUseResult);
      if (error) co_return line->close();
    }
    error_code ignored;
    way.to.shutdown(tcp::socket::shutdown_send, ignored);
  }

  const std::shared_ptr<State> state_;
  tcp::socket viewer_, server_;
  Way up_, down_;
};

Link::Link(asio::io_context& context, const LinkQuality& quality, tcp::endpoint server)
    : state_(std::make_shared<State>(context, quality, server)) {
  asio::co_spawn(context, accept(state_), asio::detached);
}

Link::~Link() {
  error_code ignored;
  state_->acceptor.close(ignored);
  for (const auto& known : state_->lines)
    if (auto line = known.lock()) line->close();
}

asio::awaitable<void> Link::accept(std::shared_ptr<State> state) {
  for (;;) {
    auto [error, socket] = co_await state->acceptor.async_accept(kUseResult);
    if (error) co_return;
    std::erase_if(state->lines, [](const auto& line) { return line.expired(); });
    auto line = std::make_shared<Line>(state, std::move(socket));
    state->lines.push_back(line);
    asio::co_spawn(state->acceptor.get_executor(), line->run(), asio::detached);
  }
}

tcp::endpoint Link::endpoint() const { return state_->acceptor.local_endpoint(); }
std::uint64_t Link::bytes_taken() const { return state_->bytes_taken; }
int Link::full_ways() const { return state_->full_ways; }

}  // namespace strata::bench
