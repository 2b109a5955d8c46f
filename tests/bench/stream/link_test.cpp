#include "bench/stream/link.h"

#include <gtest/gtest.h>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <numeric>
#include <vector>

namespace strata::bench {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;

// Returns bytes that encode their position.
std::vector<std::uint8_t> numbered(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  for (std::size_t i = 0; i < size; ++i) bytes[i] = std::uint8_t((i * 2654435761u) >> 24);
  return bytes;
}

// Two sockets with a line between them.
class LinkTest : public testing::Test {
 protected:
  void connect(const std::string& quality) {
    link_.emplace(context_, *parse_link(quality), acceptor_.local_endpoint());
    bool is_there = false;
    acceptor_.async_accept(server_, [&](auto error) { is_there = !error; });
    viewer_.connect(link_->endpoint());
    run_until([&] { return is_there; });
  }
  template <class Condition>
  void run_until(Condition condition) {
    const auto limit = Clock::now() + std::chrono::minutes(3);
    while (!condition()) {
      ASSERT_LT(Clock::now(), limit);
      context_.run_for(std::chrono::milliseconds(20));
      context_.restart();
    }
  }
  // Sends while the other end reads. Returns the received bytes and the time.
  std::pair<std::vector<std::uint8_t>, double> carry(tcp::socket& from, tcp::socket& to,
                                                     const std::vector<std::uint8_t>& bytes) {
    std::vector<std::uint8_t> arrived(bytes.size());
    bool is_done = false;
    const auto start = Clock::now();
    auto end = start;
    asio::async_write(from, asio::buffer(bytes), [](auto, std::size_t) {});
    asio::async_read(to, asio::buffer(arrived), [&](auto error, std::size_t) {
      is_done = !error;
      end = Clock::now();
    });
    run_until([&] { return is_done; });
    return {arrived, std::chrono::duration<double>(end - start).count()};
  }

  asio::io_context context_;
  tcp::acceptor acceptor_{context_, {asio::ip::address_v4::loopback(), 0}};
  tcp::socket server_{context_}, viewer_{context_};
  std::optional<Link> link_;
};

TEST(LinkQualityTest, names_are_a_round_trip_and_a_rate) {
  const auto slow = parse_link("80ms/8Mbit");
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->round_trip, std::chrono::milliseconds(80));
  EXPECT_EQ(slow->bits_per_second, 8e6);
  EXPECT_EQ(slow->name, "80ms/8Mbit");
  EXPECT_EQ(parse_link("0ms/1.5Mbit")->bits_per_second, 1.5e6);
  EXPECT_TRUE(parse_link("loopback")->is_loopback());
  for (const char* bad : {"", "80ms", "8Mbit", "80ms/0Mbit", "-1ms/8Mbit", "80ms/8Mbit ",
                          "80ms/8Gbit", "1e3ms/8Mbit", "99999ms/8Mbit", "80ms/999999Mbit"})
    EXPECT_FALSE(parse_link(bad)) << bad;
}

// Checks no upper limit of the time, because a busy machine is slower than any line.
TEST_F(LinkTest, bytes_arrive_in_order_and_never_faster_than_the_rate) {
  connect("0ms/16Mbit");
  const auto bytes = numbered(500'000);
  for (const bool is_down : {true, false}) {
    const auto [arrived, seconds] =
        is_down ? carry(server_, viewer_, bytes) : carry(viewer_, server_, bytes);
    EXPECT_EQ(arrived, bytes);
    EXPECT_GE(seconds, double(bytes.size()) * 8 / 16e6);
  }
}

TEST_F(LinkTest, a_byte_and_its_answer_take_a_round_trip) {
  connect("300ms/100Mbit");
  EXPECT_GE(carry(viewer_, server_, {1}).second, 0.15);
  EXPECT_GE(carry(server_, viewer_, {2}).second, 0.15);
}

TEST_F(LinkTest, whoever_sends_to_one_who_does_not_read_is_held_back) {
  connect("0ms/800Mbit");
  const auto bytes = numbered(64u << 20);
  bool is_sent = false;
  asio::async_write(server_, asio::buffer(bytes),
                    [&](auto error, std::size_t) { is_sent = !error; });
  run_until([&] { return link_->full_ways() == 1; });
  EXPECT_FALSE(is_sent);
  // The limit allows for the line's own queue and the kernel's buffer for a viewer that does not
  // read.
  EXPECT_LT(link_->bytes_taken(), 32u << 20);
  std::vector<std::uint8_t> arrived(bytes.size());
  bool is_read = false;
  asio::async_read(viewer_, asio::buffer(arrived),
                   [&](auto error, std::size_t) { is_read = !error; });
  run_until([&] { return is_read; });
  EXPECT_TRUE(is_sent);
  EXPECT_EQ(arrived, bytes);
}

TEST_F(LinkTest, an_end_goes_through_after_the_last_byte) {
  connect("20ms/8Mbit");
  const auto bytes = numbered(100'000);
  asio::async_write(server_, asio::buffer(bytes),
                    [&](auto, std::size_t) { server_.shutdown(tcp::socket::shutdown_send); });
  std::vector<std::uint8_t> arrived;
  bool is_over = false;
  asio::async_read(viewer_, asio::dynamic_buffer(arrived),
                   [&](auto error, std::size_t) { is_over = error == asio::error::eof; });
  run_until([&] { return is_over; });
  EXPECT_EQ(arrived, bytes);
}

TEST_F(LinkTest, the_line_ends_with_its_link) {
  connect("20ms/8Mbit");
  link_.reset();
  std::vector<std::uint8_t> nothing(1);
  int ends = 0;
  for (tcp::socket* end : {&server_, &viewer_})
    end->async_read_some(asio::buffer(nothing),
                         [&](auto error, std::size_t) { ends += bool(error); });
  run_until([&] { return ends == 2; });
}

}  // namespace
}  // namespace strata::bench
