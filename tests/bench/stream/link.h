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

// The link between a server and each of its viewers, the same in both directions.
struct LinkQuality {
  std::string name = "loopback";  // text of the option
  std::chrono::microseconds round_trip{0};
  double bits_per_second = 0;  // 0: no link
  bool is_loopback() const { return bits_per_second == 0; }
};

// Parses "loopback", or a round trip and a rate such as "20ms/50Mbit". Returns nothing for other
// texts.
std::optional<LinkQuality> parse_link(const std::string& text);

// Emulates slow links in user space, without special rights or kernel modules. Viewers connect to
// `endpoint`, which forwards each connection to the server over a separate line. In each direction,
// a line sends bytes at its rate. Each byte arrives half a round trip later, and the order of the
// bytes does not change. The line holds the bytes in transit and kQueueBytes more. Then it stops
// reading, so the kernel's buffers fill and the sender has to wait. Packet loss, jitter, TCP's
// reaction to them, and the handshake are not emulated.
//
// Everything runs on the context's thread.
class Link {
 public:
  static constexpr std::size_t kQueueBytes = 64 * 1024;
  static constexpr std::size_t kPieceBytes = 4 * 1024;  // maximum of one read: 4 ms at 8 Mbit/s

  // Throws boost::system::system_error if it cannot listen.
  Link(boost::asio::io_context& context, const LinkQuality& quality,
       boost::asio::ip::tcp::endpoint server);
  ~Link();  // closes every line
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  boost::asio::ip::tcp::endpoint endpoint() const;

  // For tests: the number of bytes read from both ends of all lines, and the number of directions
  // whose queue is full.
  std::uint64_t bytes_taken() const;
  int full_ways() const;

 private:
  struct State;
  class Line;
  static boost::asio::awaitable<void> accept(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace strata::bench
