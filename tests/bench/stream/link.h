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

// The link between a server and each of its viewers; the same in both directions.
struct LinkQuality {
  std::string name = "loopback";  // the text of the option
  std::chrono::microseconds round_trip{0};
  double bits_per_second = 0;  // 0: no link
  bool is_loopback() const { return bits_per_second == 0; }
};

// Parses "loopback", or a round trip and a rate: "20ms/50Mbit". Returns nothing for other texts.
std::optional<LinkQuality> parse_link(const std::string& text);

// An emulator of slow links in user space, without special rights or kernel modules: viewers
// connect to `endpoint`, which forwards each connection to the server over a separate line. In each
// direction a line sends each byte when its rate allows, half a round trip later, in order. It
// holds the bytes on their way and kQueueBytes more; then it stops reading until the kernel's
// buffers are also full and the sender has to wait. Not emulated: loss, jitter, TCP's reaction to
// them, and the handshake.
//
// Everything runs on the context's thread.
class Link {
 public:
  static constexpr std::size_t kQueueBytes = 64 * 1024;
  static constexpr std::size_t kPieceBytes = 4 * 1024;  // maximum for one read: 4 ms of 8 Mbit/s

  // Throws boost::system::system_error if it cannot listen.
  Link(boost::asio::io_context& context, const LinkQuality& quality,
       boost::asio::ip::tcp::endpoint server);
  ~Link();  // ends every line
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  boost::asio::ip::tcp::endpoint endpoint() const;

  // For tests: the number of bytes read from both sides of all lines, and of full directions.
  std::uint64_t bytes_taken() const;
  int full_ways() const;

 private:
  struct State;
  class Line;
  static boost::asio::awaitable<void> accept(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace strata::bench
