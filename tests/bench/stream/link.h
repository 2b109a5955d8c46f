#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace strata::bench {

// What lies between a server and each of its viewers; the same both ways.
struct LinkQuality {
  std::string name = "loopback";  // as it is asked for
  std::chrono::microseconds round_trip{0};
  double bits_per_second = 0;  // 0: nothing lies between
  bool is_loopback() const { return bits_per_second == 0; }
};

// "loopback", or a round trip and a rate: "20ms/50Mbit". Nothing where it is neither.
std::optional<LinkQuality> parse_link(const std::string& text);

// An emulator of slow links in user space, without rights or kernel modules: viewers connect to
// `endpoint`, and every connection is passed on to the server over a line of its own. Each way a
// line gives out no byte sooner than its rate allows and half a round trip after that, in order. It
// holds what is on its way and kQueueBytes more; then it reads nothing, until the kernel's buffers
// are full, too, and the sender feels it. Not emulated: loss, jitter, what TCP does about them, and
// the handshake.
//
// Everything runs on the context's thread.
class Link {
 public:
  static constexpr std::size_t kQueueBytes = 64 * 1024;
  static constexpr std::size_t kPieceBytes = 4 * 1024;  // read at once at most: 4 ms of 8 Mbit/s

  // Throws boost::system::system_error where it cannot listen.
  Link(boost::asio::io_context& context, const LinkQuality& quality,
       boost::asio::ip::tcp::endpoint server);
  ~Link();  // ends every line
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  boost::asio::ip::tcp::endpoint endpoint() const;

  // For tests: bytes that were read from either side of all lines, and how many ways are full.
  std::uint64_t bytes_taken() const;
  int full_ways() const;

 private:
  struct State;
  class Line;
  static boost::asio::awaitable<void> accept(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace strata::bench
